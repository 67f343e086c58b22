// `qtrace config`: what is right about configs, without rendering.
#pragma once

#include "experiments/commands/subcommand.h"

namespace qtrace::experiments {

// `config schema` prints the JSON Schema of configs; `config check` checks every file as a run of it would:
// exit code 1 if one of them could not be run.
void add_config_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
