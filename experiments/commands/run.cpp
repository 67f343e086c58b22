#include "experiments/commands/run.h"

#include "engine/core/check.h"
#include "experiments/commands/dry_run.h"
#include "experiments/runtime/driver_store.h"
#include "experiments/runtime/manifest.h"
#include "experiments/study/experiment.h"
#include "experiments/study/plan.h"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {
namespace {

struct RunOptions {
  std::vector<std::string> words;  // the command line
  std::vector<std::string> configs;
  std::vector<std::string> sets;
  std::string device;
  RunChoices choices;
  std::string shard;       // "i/n"; empty: all
  double time_budget = 0;  // seconds; 0: as long as it takes
  bool dry_run = false;
  bool list = false;
  bool quiet = false;
  std::optional<double> again;  // started again by itself, with these seconds left, or 0 for no budget
};

constexpr const char* kAgain = "--started-again";
constexpr double kMinute = 60, kHour = 3600;

template <class T>
bool parse_all(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  const std::size_t slash = text.find('/');
  const bool good = slash != std::string::npos &&
                    parse_all(std::string_view(text).substr(0, slash), shard.index) &&
                    parse_all(std::string_view(text).substr(slash + 1), shard.count) && shard.index >= 1 &&
                    shard.index <= shard.count;
  check(good, "--shard {}: must be i/n with 1 <= i <= n, such as 2/8", text);
  return shard;
}

// Seconds of "8h", "90min", "90m", "30s" or bare seconds.
std::string parse_duration(std::string& text) {
  const std::size_t digits = text.find_first_not_of("0123456789.");
  const std::string_view unit = digits == std::string::npos ? "" : std::string_view(text).substr(digits);
  double value = 0;
  const double scale = unit == "h"                    ? kHour
                       : unit == "min" || unit == "m" ? kMinute
                       : unit.empty() || unit == "s"  ? 1
                                                      : 0;
  if (scale == 0 || !parse_all(std::string_view(text).substr(0, digits), value) || !(value > 0)) {
    return "must be a time such as 8h, 90min or 30s";
  }
  text = std::to_string(value * scale);
  return "";
}

// The same command once more in place of this process, which hangs in the driver: what failed is not tried
// again, and the time that is left is all the time there is.
[[noreturn]] void start_again(const RunOptions& options, std::optional<double> seconds_left) {
  std::vector<std::string> words = options.words;
  if (options.again) words.resize(words.size() - 2);  // what the last start added
  words.insert(words.end(), {kAgain, std::to_string(seconds_left ? std::max(1.0, *seconds_left) : 0)});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv("/proc/self/exe", arguments.data());
  fmt::print(stderr, "error: a frame hangs, and the program cannot be started again: {}\n",
             std::strerror(errno));
  ::_exit(1);
}

int run_all(const RunOptions& options, const std::vector<Experiment>& experiments, SceneStore& scenes,
            Progress& progress) {
  gpu::Context context(options.device);
  choose_driver(context, progress);
  progress.note("device: " + device_text(context.device()));
  for (const Experiment& experiment : experiments) check_device(experiment, context, scenes);
  Stopper stopper;
  if (options.time_budget > 0) stopper.set_budget(options.time_budget);
  const auto give_up = [&](const std::string& why) {
    progress.warning(why + "; the program starts itself anew, as the driver may hang");
    if (options.choices.fail_fast) ::_exit(1);
    start_again(options, stopper.seconds_left());
  };
  try {
    bool all_good = true;
    for (const Experiment& experiment : experiments) {
      all_good = run_experiment(experiment, context, scenes, options.choices, stopper, give_up, progress) &&
                 all_good;
    }
    return all_good ? 0 : 1;
  } catch (const Stopped& stopped) {
    progress.warning(
        fmt::format("{}; all that was done is kept, and the same command goes on with it", stopped.why));
    return stopped.exit_code;
  }
}

int run_command(const RunOptions& given) {
  RunOptions options = given;
  if (options.again) {
    options.choices.fresh = false;
    options.choices.keep_failed = true;
    options.time_budget = *options.again;
  }
  if (!options.shard.empty()) options.choices.shard = parse_shard(options.shard);
  check(!options.choices.merge || options.choices.shard.is_whole(),
        "--merge takes all shards together; leave --shard out");
  check(
      !options.choices.fresh || options.choices.shard.is_whole(),
      "--fresh would put aside what other shards write; move the folder away by hand before the first shard");
  Progress progress(Progress::detect(options.quiet));
  SceneStore scenes;
  const std::vector<Experiment> experiments =
      load_experiments(options.configs, options.sets, scenes, progress);
  for (const Experiment& experiment : experiments) chosen_turns(experiment, options.choices);  // or an error
  if (options.list) {
    for (const Experiment& experiment : experiments) {
      for (const Turn& turn : chosen_turns(experiment, options.choices)) {
        fmt::print("{}\n", experiment.runs[turn.place].id);
      }
    }
    return 0;
  }
  if (options.dry_run) {
    gpu::Context context(options.device);
    choose_driver(context, progress);
    for (const Experiment& experiment : experiments) {
      check_device(experiment, context, scenes);
      fmt::print("{}", dry_run(experiment, context, scenes, options.choices, progress));
    }
    return 0;
  }
  return run_all(options, experiments, scenes, progress);
}

}  // namespace

void add_run_command(CLI::App& app, const std::vector<std::string>& words, Action& action) {
  const auto kept = std::make_shared<RunOptions>();
  RunOptions& options = *kept;
  options.words = words;
  CLI::App* run =
      app.add_subcommand("run", "Run all runs of the given experiments, or what is missing of them");
  RunChoices& choices = options.choices;
  run->add_option("CONFIG", options.configs, "experiment file (JSON); `qtrace keys` lists its keys")
      ->required();
  add_repeated_option(*run, "--set", options.sets,
                      "key=value, changes a key of the configs: --set frames=8 --set rl.bins_phi=4 "
                      "--set 'sweep.seed=[1,2]'");
  run->add_option("--out", choices.root, "folder of the results")->capture_default_str();
  run->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  run->add_option("--only", choices.only, "only the runs whose name fits this pattern with * and ?");
  run->add_option(
      "--shard", options.shard,
      "i/n: only the i-th of n parts of the runs; the parts may run at the same time, and --merge ends them");
  run->add_option(
         "--time-budget", options.time_budget,
         "stops after this time, such as 8h or 90min, with all configurations about as far as each other")
      ->transform(CLI::Validator(parse_duration, "TIME"));
  run->add_flag("--fresh", choices.fresh, "puts earlier results aside instead of going on with them");
  run->add_flag("--fail-fast", choices.fail_fast, "stops at the first run that fails");
  run->add_flag("--keep-failed", choices.keep_failed, "runs that failed before are not tried again");
  run->add_flag("--references-only", choices.references_only,
                "renders the references that are missing, no runs");
  run->add_flag("--merge", choices.merge, "renders nothing: writes the files about the runs that are there");
  run->add_flag("--list", options.list, "lists the names of the chosen runs, and does nothing");
  run->add_flag(
      "--dry-run", options.dry_run,
      "checks everything, measures some frames, tells what is to do and what it takes; writes nothing");
  run->add_flag("--quiet", options.quiet, "no progress; warnings and the table stay");
  run->add_option(kAgain, options.again)->group("");  // not for people
  run->callback([&action, kept] { action = [kept] { return run_command(*kept); }; });
}

}  // namespace qtrace::experiments
