// `qtrace run`: its options, and what it does.
#pragma once

#include "experiments/commands/subcommand.h"

#include <string>
#include <vector>

namespace qtrace::experiments {

// Everything is read and checked before the first folder is made. The exit code is 0 where all chosen runs
// finished, 1 where something failed, kExitTimeUp, or 128 + the signal that stopped it. `words`: the whole
// command line, with which the program starts itself again where a driver hangs.
void add_run_command(CLI::App& app, const std::vector<std::string>& words, Action& action);

}  // namespace qtrace::experiments
