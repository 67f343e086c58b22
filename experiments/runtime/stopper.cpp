#include "experiments/runtime/stopper.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>

namespace qtrace::experiments {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
constexpr int kSignalExit = 128;

// A signal handler can reach nothing but what has static lifetime; Stopper is the only reader.
volatile std::sig_atomic_t received = 0;

// Files are whole whenever the process ends, so that the second signal needs no clean-up.
extern "C" void note_signal(int signal) {
  if (received != 0) ::_exit(kSignalExit + signal);
  received = signal;
}

void handle_with(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) ::sigaction(signal, &action, nullptr);
}

}  // namespace

Stopper::Stopper() {
  received = 0;
  handle_with(note_signal);
}

Stopper::~Stopper() { handle_with(SIG_DFL); }

void Stopper::set_budget(double seconds) {
  deadline_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::optional<double> Stopper::seconds_left() const {
  if (!deadline_) return std::nullopt;
  return std::chrono::duration<double>(*deadline_ - Clock::now()).count();
}

std::optional<Stopped> Stopper::reason() const {
  const int signal = received;
  if (signal != 0) {
    return Stopped{fmt::format("interrupted by SIG{}", ::sigabbrev_np(signal)), kSignalExit + signal};
  }
  if (deadline_ && Clock::now() >= *deadline_) return Stopped{"the time budget is used up", kExitTimeUp};
  return std::nullopt;
}

void Stopper::check() const {
  if (auto stopped = reason()) throw *stopped;
}

}  // namespace qtrace::experiments
