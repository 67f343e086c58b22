// Times of work on host and device, and what many rounds of them say.
#pragma once

#include <chrono>
#include <ctime>
#include <vector>

namespace qtrace::bench {

struct Duration {
  double wall_s = 0;
  double cpu_s = 0;  // of all threads of this process; on a software device the device's time too
};

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// `work` must wait for what it starts.
template <class Work>
Duration timed(Work&& work) {
  const double cpu = cpu_seconds();
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {wall.count(), cpu_seconds() - cpu};
}

// A figure over the rounds: its median and its quartiles.
struct Spread {
  double median = 0;
  double low = 0;
  double high = 0;
};

Spread spread_of(const std::vector<double>& values);

// Of this over that, round by round, so that what disturbs a round disturbs both.
Spread ratio_of(const std::vector<double>& numerators, const std::vector<double>& denominators);

}  // namespace qtrace::bench
