// `qtrace run`: its options, and what it does.
#pragma once

#include "experiments/study/experiment.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace qtrace::experiments {

struct RunOptions {
  std::vector<std::string> configs;
  std::vector<std::string> sets;
  std::string device;
  RunChoices choices;
  std::string shard;       // "i/n"; empty: all
  double time_budget = 0;  // seconds; 0: as long as it takes
  bool dry_run = false;
  bool list = false;
  bool quiet = false;
};

void add_run_command(CLI::App& app, RunOptions& options);

// Everything is read and checked before the first folder is made. Returns the exit code: 0 where all chosen
// runs finished, 1 where something failed, kExitTimeUp, or 128 + the signal that stopped it.
int run_command(const RunOptions& options);

}  // namespace qtrace::experiments
