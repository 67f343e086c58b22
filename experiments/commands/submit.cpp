#include "experiments/commands/submit.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/runtime/subprocess.h"
#include "experiments/study/experiment.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <memory>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

struct Plan {
  Experiment experiment;
  fs::path folder;  // of the scripts
  std::vector<SlurmScript> scripts;
};

// Everything is read and checked before the first folder is made or job submitted.
std::vector<Plan> plan_all(const SubmitOptions& options) {
  Progress progress(Progress::detect(false));
  SceneStore scenes;
  std::vector<Plan> plans;
  for (Experiment& experiment : load_experiments(options.configs, options.sets, scenes, progress)) {
    const std::size_t runs = experiment.runs.size();
    check(options.shards >= 1 && static_cast<std::size_t>(options.shards) <= runs,
          "--shards is {}, but must be from 1 to {}, the number of runs of {}", options.shards, runs,
          experiment.file.string());
    Plan plan{std::move(experiment), {}, {}};
    plan.folder = fs::absolute(fs::path(options.out) / plan.experiment.name / "slurm").lexically_normal();
    plan.scripts = slurm_scripts(plan.experiment, options, fs::canonical("/proc/self/exe"), plan.folder);
    plans.push_back(std::move(plan));
  }
  return plans;
}

std::string trimmed(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text;
}

// Submits one script and returns the job's number. Throws Error with Slurm's own words.
std::string submit_script(const fs::path& script, const std::vector<std::string>& options) {
  std::vector<std::string> words{"sbatch", "--parsable"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script.string());
  const CommandResult result = run_program(words);
  const std::string job = trimmed(result.out.substr(0, result.out.find(';')));  // "job;cluster"
  const bool is_number =
      !job.empty() && std::ranges::all_of(job, [](char c) { return c >= '0' && c <= '9'; });
  check(result.exit_code == 0 && is_number, "{}: Slurm refuses the job: {}", script.string(),
        trimmed(result.err + result.out));
  return job;
}

// References, then the array, then the merge: the merge also after a task that failed, because it says what
// is missing; the array not without its references.
std::vector<std::string> submit_jobs(const Plan& plan) {
  std::vector<std::string> jobs;
  try {
    for (const SlurmScript& script : plan.scripts) {
      std::vector<std::string> options;
      if (script.stage == "shards") {
        options = {"--dependency=afterok:" + jobs.back(), "--kill-on-invalid-dep=yes"};
      } else if (script.stage == "merge") {
        options = {"--dependency=afterany:" + jobs.back()};
      }
      jobs.push_back(submit_script(plan.folder / (script.stage + ".sbatch"), options));
    }
  } catch (const Error& error) {
    if (jobs.empty()) throw;
    std::vector<std::string> words{"scancel"};
    words.insert(words.end(), jobs.begin(), jobs.end());
    const bool cancelled = run_program(words).exit_code == 0;
    fail("{}; the jobs before it, {}, {}", error.what(), fmt::join(jobs, " "),
         cancelled ? "are cancelled again" : "cannot be cancelled: scancel them");
  }
  return jobs;
}

std::string jobs_text(const Plan& plan, const std::vector<std::string>& jobs, int shards) {
  std::string text =
      fmt::format("{}: {} runs in {} shards\n", plan.experiment.name, plan.experiment.runs.size(), shards);
  text += fmt::format("  job {}: references\n  job {}: array of shards 1 to {}, after {}\n", jobs[0], jobs[1],
                      shards, jobs[0]);
  text += fmt::format("  job {}: merge, after {}\n", jobs[2], jobs[1]);
  text += fmt::format("Scripts and logs: {}\n", plan.folder.string());
  text += fmt::format("Watch: squeue --jobs {}; qtrace status {}\n", fmt::join(jobs, ","),
                      shell_word(plan.folder.parent_path().string()));
  text +=
      fmt::format("Stop: scancel {}; the same submission again goes on from there\n", fmt::join(jobs, " "));
  return text;
}

}  // namespace

std::string submit(const SubmitOptions& options) {
  const std::vector<Plan> plans = plan_all(options);
  std::string text;
  if (options.dry_run) {
    for (const Plan& plan : plans) {
      for (const SlurmScript& script : plan.scripts) {
        text += fmt::format("# {}/{}.sbatch\n{}\n", plan.folder.string(), script.stage, script.text);
      }
    }
    return text;
  }
  check(
      on_path("sbatch"),
      "sbatch is not on the PATH: submit from a node where Slurm's commands are, or look at the scripts with "
      "--dry-run");
  for (const Plan& plan : plans) {
    make_folder(plan.folder);
    for (const SlurmScript& script : plan.scripts) {
      write_file(plan.folder / (script.stage + ".sbatch"), script.text);
    }
    text += jobs_text(plan, submit_jobs(plan), options.shards);
  }
  return text;
}

void add_submit_command(CLI::App& app, Action& action) {
  const auto kept = std::make_shared<SubmitOptions>();
  SubmitOptions& options = *kept;
  CLI::App* submit = app.add_subcommand(
      "submit", "Submit experiments to a cluster: references, then the runs in shards, then their merge");
  submit->add_option("CONFIG", options.configs, "experiment file (JSON)")->required();
  submit->add_flag("--slurm")->required()->description("the cluster's scheduler; the only one so far");
  submit->add_option("--shards", options.shards, "parts that can run at the same time: tasks of a job array")
      ->required();
  add_repeated_option(*submit, "--set", options.sets, "key=value, as in `qtrace run`");
  submit->add_option("--out", options.out, "folder of the results, which all nodes see")
      ->capture_default_str();
  submit->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  submit->add_option("--cpus", options.cpus, "of each job; also the threads of the software driver")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  submit->add_option("--time", options.time, "of each job, as sbatch wants it; out of it, a job continues");
  submit->add_option("--partition", options.partition, "of all jobs");
  add_repeated_option(*submit, "--sbatch", options.sbatch,
                      "further options of all jobs: --sbatch='--mem=4G --gres=gpu:1'");
  submit->add_flag("--dry-run", options.dry_run,
                   "check everything, print the scripts, write and submit nothing");
  submit->callback([&action, kept] {
    action = [kept] {
      fmt::print("{}", experiments::submit(*kept));
      return 0;
    };
  });
}

}  // namespace qtrace::experiments
