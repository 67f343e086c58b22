// When to stop before the work is done: a signal came, or the time that was allowed is over.
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace qtrace::experiments {

// Exit codes besides 0 (all done), 1 (something failed) and 2 (wrong usage). A signal's is 128 + its number.
inline constexpr int kExitTimeUp = 4;

// Thrown where work ends early with all that it needs to go on later. No std::exception, so that nothing
// that handles failures takes it for one.
struct Stopped {
  std::string why;    // "interrupted by SIGINT", ...
  int exit_code = 0;  // of the program
};

class Stopper {
 public:
  using Clock = std::chrono::steady_clock;

  // From now on SIGINT, SIGTERM and SIGHUP are noted the first time, and end the process at once the second
  // time. One object at a time; the destructor gives the signals back.
  Stopper();
  ~Stopper();
  Stopper(const Stopper&) = delete;
  Stopper& operator=(const Stopper&) = delete;

  void set_budget(double seconds);             // from now
  std::optional<double> seconds_left() const;  // of the budget; nothing where there is none

  // Nothing as long as work may go on.
  std::optional<Stopped> reason() const;

  // Throws Stopped.
  void check() const;

 private:
  std::optional<Clock::time_point> deadline_;
};

}  // namespace qtrace::experiments
