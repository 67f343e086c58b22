// `qtrace devices`: what this machine can compute on.
#pragma once

#include "experiments/commands/subcommand.h"

namespace qtrace::experiments {

void add_devices_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
