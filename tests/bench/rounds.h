// Interleaved measurement: everything that is compared takes its turn in every round.
#pragma once

#include "tests/bench/timing.h"

#include <functional>
#include <string>
#include <vector>

namespace qtrace::bench {

// What is timed once in every round.
struct Contender {
  std::string name;
  std::function<Duration()> measure;
  std::vector<double> wall_s = {};
  std::vector<double> cpu_s = {};
  std::vector<double> host_s = {};
};

// Two measurements each to warm up, then `rounds`. Each round starts with another contender, so that none
// always follows the same one. A turn is one measurement, or the mean of many short ones.
void run_rounds(std::vector<Contender>& contenders, int rounds);

// A contender's time in one round, as the CSV files of raw times have it.
struct RoundRow {
  std::vector<std::string> keys;  // what tells contenders apart, in the order of the columns
  std::size_t round;              // from 1
  Duration time;
};

void append_rounds(std::vector<RoundRow>& rows, const std::vector<std::string>& keys,
                   const Contender& contender);

// `keys`: names of the columns of RoundRow::keys.
std::string rounds_csv(const std::vector<std::string>& keys, const std::vector<RoundRow>& rows);

}  // namespace qtrace::bench
