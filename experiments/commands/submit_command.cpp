#include "experiments/commands/submit_command.h"

namespace qtrace::experiments {

CLI::App* add_submit_command(CLI::App& app, SubmitOptions& options) {
  CLI::App* submit = app.add_subcommand(
      "submit", "Submit experiments to a cluster: references, then the runs in shards, then their merge");
  submit->add_option("CONFIG", options.configs, "experiment file (JSON)")->required();
  submit->add_flag("--slurm")->required()->description("the cluster's scheduler; the only one so far");
  submit->add_option("--shards", options.shards, "parts that can run at the same time: tasks of a job array")
      ->required();
  submit->add_option("--set", options.sets, "key=value, as in `qtrace run`")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  submit->add_option("--out", options.out, "folder of the results, which all nodes see")
      ->capture_default_str();
  submit->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  submit->add_option("--cpus", options.cpus, "of each job; also the threads of the software driver")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  submit->add_option("--time", options.time, "of each job, as sbatch wants it; out of it, a job continues");
  submit->add_option("--partition", options.partition, "of all jobs");
  submit
      ->add_option("--sbatch", options.sbatch,
                   "further options of all jobs: --sbatch='--mem=4G --gres=gpu:1'")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  submit->add_flag("--dry-run", options.dry_run,
                   "check everything, print the scripts, write and submit nothing");
  return submit;
}

}  // namespace qtrace::experiments
