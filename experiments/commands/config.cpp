#include "experiments/commands/config.h"

#include "experiments/config/config_errors.h"
#include "experiments/config/json_schema.h"
#include "experiments/runtime/manifest.h"
#include "experiments/study/experiment.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace qtrace::experiments {
namespace {

struct ConfigOptions {
  std::vector<std::string> files;
  std::vector<std::string> sets;
  std::string device;
  bool no_device = false;
};

// Everything that `run` checks before its first frame; what is wrong goes to stderr. Returns whether all is
// good.
bool check_config(const std::string& file, const ConfigOptions& options, const gpu::Context* context,
                  SceneStore& scenes, Progress& progress) {
  Experiment experiment;
  std::vector<std::string> errors = config_errors(file, options.sets, experiment);
  try {
    if (errors.empty()) load_scenes(experiment, scenes, progress);
    if (errors.empty() && context != nullptr) check_device(experiment, *context, scenes);
  } catch (const Error& error) {
    errors.emplace_back(error.what());
  }
  for (const std::string& error : errors) fmt::print(stderr, "error: {}\n", error);
  if (!errors.empty()) return false;
  std::set<std::string> configurations;
  for (const Run& run : experiment.runs) configurations.insert(run.configuration);
  fmt::print("{}: good: '{}', runs: {}, configurations: {}\n", file, experiment.name, experiment.runs.size(),
             configurations.size());
  return true;
}

int check_configs(const ConfigOptions& options) {
  std::optional<gpu::Context> context;
  if (!options.no_device) context.emplace(options.device);
  Progress progress(Progress::detect(true));
  SceneStore scenes;
  bool all_good = true;
  for (const std::string& file : options.files) {
    all_good = check_config(file, options, context ? &*context : nullptr, scenes, progress) && all_good;
  }
  return all_good ? 0 : 1;
}

}  // namespace

void add_config_command(CLI::App& app, Action& action) {
  CLI::App* config =
      app.add_subcommand("config", "The schema of experiment files, and whether files are good");
  config->require_subcommand(1);
  CLI::App* schema = config->add_subcommand(
      "schema", "Prints a JSON Schema of experiment files, for editors and other programs");
  schema->callback([&action] {
    action = [] {
      fmt::print("{}", json_text(config_schema()));
      return 0;
    };
  });
  CLI::App* check = config->add_subcommand(
      "check",
      "Checks files and their scenes as a run would, without rendering: exit code 1 if one is wrong");
  const auto options = std::make_shared<ConfigOptions>();
  check->add_option("FILE", options->files, "experiment files (JSON)")->required();
  add_repeated_option(*check, "--set", options->sets, "key=value, as of `qtrace run`");
  check->add_option("--device", options->device, "index or part of a name, see `qtrace devices`");
  check->add_flag("--no-device", options->no_device,
                  "leaves out what depends on a device: whether its buffers are large enough");
  check->callback([&action, options] { action = [options] { return check_configs(*options); }; });
}

}  // namespace qtrace::experiments
