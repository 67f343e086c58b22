#include "tests/bench/rounds.h"

#include "experiments/files/csv.h"

#include <chrono>
#include <cstdint>

namespace qtrace::bench {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kWarmUps = 2;
// A device that waits lowers its clock, and work of a millisecond does not raise it again.
constexpr std::chrono::milliseconds kLeastTurn{20};

Duration operator+(const Duration& a, const Duration& b) {
  return {a.wall_s + b.wall_s, a.cpu_s + b.cpu_s, a.host_s + b.host_s};
}

Duration operator/(const Duration& a, double count) {
  return {a.wall_s / count, a.cpu_s / count, a.host_s / count};
}

// What takes long is measured once; the rest for a while in vain, and then as the mean of as long again.
Duration turn_of(const Contender& c) {
  const auto start = Clock::now();
  const Duration once = c.measure();
  if (Clock::now() - start >= kLeastTurn) return once;
  while (Clock::now() - start < kLeastTurn) c.measure();
  Duration sum;
  int count = 0;
  do {
    sum = sum + c.measure();
    ++count;
  } while (Clock::now() - start < 2 * kLeastTurn);
  return sum / count;
}

}  // namespace

void run_rounds(std::vector<Contender>& contenders, int rounds) {
  for (int i = 0; i < kWarmUps; ++i) {
    for (const Contender& c : contenders) c.measure();
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      Contender& c = contenders[(i + static_cast<std::size_t>(round)) % contenders.size()];
      const Duration time = turn_of(c);
      c.wall_s.push_back(time.wall_s);
      c.cpu_s.push_back(time.cpu_s);
      c.host_s.push_back(time.host_s);
    }
  }
}

void append_rounds(std::vector<RoundRow>& rows, const std::vector<std::string>& keys,
                   const Contender& contender) {
  for (std::size_t i = 0; i < contender.wall_s.size(); ++i) {
    rows.push_back({keys, i + 1, {contender.wall_s[i], contender.cpu_s[i], contender.host_s[i]}});
  }
}

std::string rounds_csv(const std::vector<std::string>& keys, const std::vector<RoundRow>& rows) {
  using experiments::Column;
  std::vector<Column<RoundRow>> columns;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    columns.push_back({keys[i], [i](const RoundRow& r) { return r.keys[i]; }});
  }
  columns.push_back({"round", [](const RoundRow& r) { return std::uint64_t{r.round}; }});
  columns.push_back({"wall_ms", [](const RoundRow& r) { return kMilliseconds * r.time.wall_s; }});
  columns.push_back({"cpu_ms", [](const RoundRow& r) { return kMilliseconds * r.time.cpu_s; }});
  columns.push_back({"host_ms", [](const RoundRow& r) { return kMilliseconds * r.time.host_s; }});
  return experiments::csv_text(columns, rows);
}

}  // namespace qtrace::bench
