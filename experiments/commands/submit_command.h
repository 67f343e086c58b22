// The options of `qtrace submit`.
#pragma once

#include "experiments/commands/slurm.h"

#include <CLI/CLI.hpp>

namespace qtrace::experiments {

CLI::App* add_submit_command(CLI::App& app, SubmitOptions& options);

}  // namespace qtrace::experiments
