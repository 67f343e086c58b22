// An experiment as three Slurm jobs: its references, an array with one task per shard, and the merge.
#pragma once

#include "experiments/config/experiment_config.h"

#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::experiments {

struct SubmitOptions {
  std::vector<std::string> configs;
  std::vector<std::string> sets;
  std::string out = "results";
  std::string device;
  int shards = 0;
  int cpus = 1;
  std::string time;
  std::string partition;
  std::vector<std::string> sbatch;  // each a line of further options
  bool dry_run = false;
};

// How long before the end of its time a job is told to write a checkpoint.
constexpr int kWarningSeconds = 60;
// Slurm may do so a minute earlier (man sbatch, --signal), and a job needs time to get anywhere.
constexpr int kLeastSeconds = 300;

struct SlurmScript {
  std::string stage;  // references, shards or merge
  std::string text;
};

// The scripts of the three jobs. `program` is this program, `folder` where the scripts and their logs will
// be; both absolute. Throws Error for options and paths that a script cannot hold.
std::vector<SlurmScript> slurm_scripts(const Experiment& experiment, const SubmitOptions& options,
                                       const std::filesystem::path& program,
                                       const std::filesystem::path& folder);

}  // namespace qtrace::experiments
