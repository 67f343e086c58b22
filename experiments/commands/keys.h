// `qtrace keys`: every key that experiment files may have.
#pragma once

#include "experiments/commands/subcommand.h"

namespace qtrace::experiments {

void add_keys_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
