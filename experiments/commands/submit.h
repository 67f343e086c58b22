// `qtrace submit`: experiments as jobs of a cluster.
#pragma once

#include "experiments/commands/slurm_scripts.h"
#include "experiments/commands/subcommand.h"

#include <string>

namespace qtrace::experiments {

// Reads and checks all configs, writes their scripts to OUT/<experiment>/slurm, and submits them. Returns
// what the user needs to know; with dry_run the scripts, and nothing is written or submitted.
// Throws Error before the first job where something is wrong, and cancels the jobs of an experiment again
// where Slurm refuses a later one.
std::string submit(const SubmitOptions& options);

void add_submit_command(CLI::App& app, Action& action);

}  // namespace qtrace::experiments
