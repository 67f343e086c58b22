#include "experiments/cli.h"

#include "engine/core/check.h"
#include "experiments/compare.h"
#include "experiments/experiment.h"
#include "experiments/inspect.h"
#include "experiments/manifest.h"
#include "experiments/slurm.h"
#include "experiments/text_table.h"
#include "experiments/version.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>

namespace qtrace::experiments {
namespace {

struct RunOptions {
  std::vector<std::string> configs;
  std::vector<std::string> sets;
  std::string out = "results";
  std::string device;
  bool dry_run = false;
  bool quiet = false;
};

// Everything is read and checked before the first folder is made.
int command_run(const RunOptions& options) {
  Progress progress(Progress::detect(options.quiet));
  SceneStore scenes;
  std::vector<Experiment> experiments;
  for (const std::string& file : options.configs) {
    Experiment next = load_experiment(file, options.sets);
    for (const Experiment& other : experiments) {
      check(other.name != next.name, "{} and {} are both called '{}'; their results would share a folder",
            other.file.string(), next.file.string(), next.name);
    }
    load_scenes(next, scenes, progress);
    experiments.push_back(std::move(next));
  }
  if (options.dry_run) {
    for (const Experiment& experiment : experiments) {
      fmt::print("{}", describe_runs(experiment, scenes, options.out));
    }
    return 0;
  }
  const gpu::Context context(options.device);
  progress.note("device: " + device_text(context.device()));
  for (const Experiment& experiment : experiments) check_device(experiment, context, scenes);
  bool all_finished = true;
  for (const Experiment& experiment : experiments) {
    all_finished = run_experiment(experiment, context, scenes, options.out, progress) && all_finished;
  }
  return all_finished ? 0 : 1;
}

int command_devices() {
  std::vector<std::vector<std::string>> rows;
  bool usable = false;
  for (const gpu::DeviceInfo& device : gpu::list_devices()) {
    usable = usable || device.problem.empty();
    rows.push_back({std::to_string(device.index), device.renderer, device.gl_version, device.platform,
                    device.software ? "software" : "hardware",
                    device.problem.empty() ? "usable" : "not usable: " + device.problem});
  }
  fmt::print("{}", plain_table({"index", "renderer", "OpenGL", "platform", "kind", "state"}, rows));
  check(usable,
        "no device can be used: OpenGL 4.5 through EGL is needed; Mesa's llvmpipe needs no hardware "
        "(Debian: libegl-mesa0 and libgl1-mesa-dri)");
  return 0;
}

int command_keys() {
  std::vector<std::vector<std::string>> rows;
  for (const KeyRow& row : list_knobs(ExperimentKeys{})) {
    rows.push_back({row.key, row.type, row.default_value, row.unit, row.help});
  }
  fmt::print("{}", plain_table({"key", "type", "default", "unit", "meaning"}, rows));
  return 0;
}

void add_run_command(CLI::App& app, RunOptions& options) {
  CLI::App* run = app.add_subcommand("run", "Run all runs of the given experiments");
  run->add_option("CONFIG", options.configs, "experiment file (JSON); `qtrace keys` lists its keys")
      ->required();
  run->add_option("--set", options.sets,
                  "key=value, changes a key of the configs: --set frames=8 --set rl.bins_phi=4 "
                  "--set 'sweep.seed=[1,2]'")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  run->add_option("--out", options.out, "folder of the results")->capture_default_str();
  run->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  run->add_flag("--dry-run", options.dry_run, "check everything, list the runs, write nothing");
  run->add_flag("--quiet", options.quiet, "no progress; warnings and the table stay");
}

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

CLI::App* add_inspect_command(CLI::App& app, InspectOptions& options) {
  constexpr int kMostSamples = 1 << 20;
  CLI::App* inspect =
      app.add_subcommand("inspect", "Pictures of a run's cells, and of what one of them has learned");
  inspect->add_option("RUN_FOLDER", options.folder, "results/<experiment>/<run>, made with save_table")
      ->required();
  inspect->add_option("--pixel", options.pixel, "X,Y: whose cell is shown (default: the middle of the image)")
      ->delimiter(',')
      ->expected(2);
  inspect->add_option("--samples", options.samples, "paths per pixel of the true hemisphere")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostSamples));
  inspect->add_option("--frame", options.frame, "after which frame the table was saved (default: the last)");
  inspect->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  return inspect;
}

CLI::App* add_compare_command(CLI::App& app, CompareOptions& options) {
  CLI::App* compare = app.add_subcommand("compare", "Error metrics of an image against a reference");
  compare->add_option("IMAGE", options.image, "OpenEXR file: R, G, B, a layer of them, X, Y, Z or Y")
      ->required();
  compare->add_option("REFERENCE", options.reference, "the same, perhaps with variances")->required();
  compare->add_option("--layer", options.layer, "the layer or part to compare, where there are several");
  compare->add_option("--reference-layer", options.reference_layer,
                      "of the reference (default: --layer where it has that, else its main image)");
  compare->add_option("--heat", options.heat,
                      "writes the error of every pixel: .png in false colours, .exr the values");
  const auto& names = EnumNames<PixelError>::values;
  const auto choose = [&options, &names](const std::string& name) {
    options.heat_metric =
        static_cast<PixelError>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  compare->add_option_function<std::string>("--heat-metric", choose, "default: relmse")
      ->check(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
  compare
      ->add_option("--heat-max", options.heat_top,
                   "error with the brightest colour (default: flip 1, else the 99th percentile)")
      ->check(CLI::PositiveNumber);
  return compare;
}

int dispatch(int argc, const char* const* argv) {
  CLI::App app("qtrace: convergence studies of reinforcement-learned light transport");
  app.require_subcommand(1);
  app.set_version_flag("--version", software());
  RunOptions options;
  add_run_command(app, options);
  SubmitOptions submit_options;
  CLI::App* submitted = add_submit_command(app, submit_options);
  InspectOptions inspect_options;
  CLI::App* inspect = add_inspect_command(app, inspect_options);
  CompareOptions compare_options;
  CLI::App* compare = add_compare_command(app, compare_options);
  CLI::App* devices = app.add_subcommand("devices", "List what this machine can compute on");
  CLI::App* keys = app.add_subcommand("keys", "List the keys of experiment files");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (compare->parsed()) {
    fmt::print("{}", compare_files(compare_options));
    return 0;
  }
  if (submitted->parsed()) {
    fmt::print("{}", submit(submit_options));
    return 0;
  }
  if (inspect->parsed()) {
    Progress progress(Progress::detect(false));
    fmt::print("{}", inspect_run(inspect_options, progress));
    return 0;
  }
  if (devices->parsed()) return command_devices();
  if (keys->parsed()) return command_keys();
  return command_run(options);
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  try {
    return dispatch(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
}

}  // namespace qtrace::experiments
