// Times of work on host and device, and what many rounds of them say.
#pragma once

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

namespace qtrace::bench {

inline constexpr double kMilliseconds = 1e3;  // of a second

struct Duration {
  double wall_s = 0;
  double cpu_s = 0;   // of all threads of this process; on a software device the device's time too
  double host_s = 0;  // processor time of the calling thread until the work was handed over; see timed()
};

inline double cpu_seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// `submit` hands work over, `wait` waits for it. What the calling thread computes in submit() is the host's
// share: llvmpipe runs shaders on threads of its own, for which this one sleeps.
template <class Submit, class Wait>
Duration timed(Submit&& submit, Wait&& wait) {
  const double cpu = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
  const double host = cpu_seconds(CLOCK_THREAD_CPUTIME_ID);
  const auto start = std::chrono::steady_clock::now();
  submit();
  const double host_end = cpu_seconds(CLOCK_THREAD_CPUTIME_ID);
  wait();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu, host_end - host};
}

// A figure over the rounds: its median and its quartiles.
struct Spread {
  double median = 0;
  double low = 0;
  double high = 0;
};

Spread spread_of(const std::vector<double>& values);
Spread operator*(double scale, const Spread& spread);
std::string text_of(const Spread& spread);  // "1.2 [1.1, 1.3]"

// Of so much done in each of these times: per second.
Spread rate_of(double amount, const std::vector<double>& seconds);

// Of this over that, round by round, so that what disturbs a round disturbs both.
Spread ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators);

}  // namespace qtrace::bench
