#include "experiments/commands/status.h"

#include "engine/core/check.h"
#include "experiments/files/folder_lock.h"
#include "experiments/records/run_status.h"
#include "experiments/runtime/progress.h"
#include "experiments/study/results_folder.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <vector>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFailures = 10;  // listed

bool is_experiment(const fs::path& folder) {
  if (!fs::is_regular_file(folder / "manifest.json")) return false;
  try {
    return read_json_file(folder / "manifest.json").contains("runs");
  } catch (const Error&) {
    return false;
  }
}

// Nothing where the file is missing or being replaced.
Json read_if_there(const fs::path& file) {
  try {
    return fs::exists(file) ? read_json_file(file) : Json();
  } catch (const Error&) {
    return {};
  }
}

std::string state_line(const Json& state) {
  const double relmse = state.value("relmse", -1.0);
  return fmt::format("  now: {}: frame {}/{}{}, {} left of this, {} of all\n", state.value("label", ""),
                     state.value("frame", 0), state.value("frames", 0),
                     relmse < 0 ? "" : fmt::format(", relMSE {:.3g}", relmse),
                     duration_text(state.value("stage_left_s", 0.0)),
                     duration_text(state.value("all_left_s", 0.0)));
}

std::string experiment_status(const fs::path& folder) {
  const Json manifest = read_json_file(folder / "manifest.json");
  const std::string finished(enum_name(RunStatus::finished));
  std::map<std::string, int> counts;
  std::string failures;
  std::size_t failed = 0;
  for (const Json& entry : manifest.at("runs")) {
    const std::string id = entry.at("run").get<std::string>();
    // The run's own manifest is newer, and all there is of shards.
    const Json own = read_if_there(folder / id / "manifest.json");
    const std::string status =
        (own.is_object() ? own : entry).value("status", std::string(enum_name(RunStatus::waiting)));
    ++counts[status];
    if (status != enum_name(RunStatus::failed) || ++failed > kMostFailures) continue;
    failures += fmt::format("  failed: {}: {}\n", id, own.is_object() ? own.value("reason", "") : "");
  }
  if (failed > kMostFailures) failures += fmt::format("  and {} more\n", failed - kMostFailures);
  const std::string holder = FolderLock::holder(lock_file(folder));
  const bool is_whole = counts[finished] == static_cast<int>(manifest.at("runs").size());
  const std::string state = !holder.empty() ? "at work: " + holder
                            : is_whole      ? "finished"
                                            : "nobody is at work; the same `qtrace run` goes on";
  std::string text = fmt::format("{}: {}\n  {} of {} runs finished", folder.filename().string(), state,
                                 counts[finished], manifest.at("runs").size());
  for (const auto& [status, count] : counts) {
    if (status == finished || count == 0) continue;
    text += fmt::format(", {} {}", count,
                        status == enum_name(RunStatus::running) && holder.empty() ? "cut off" : status);
  }
  text += '\n';
  if (!holder.empty()) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (!entry.path().filename().string().starts_with(kProgressFile)) continue;
      if (const Json now = read_if_there(entry.path()); now.is_object()) text += state_line(now);
    }
  }
  return text + failures;
}

}  // namespace

std::string status_text(const fs::path& folder) {
  check(fs::is_directory(folder),
        "{}: no such folder; the results of `qtrace run` are needed, such as results", folder.string());
  if (is_experiment(folder)) return experiment_status(fs::weakly_canonical(folder));
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory() && is_experiment(entry.path())) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  check(!found.empty(),
        "{}: holds no experiment; its folder or the one above is needed, such as results/quickstart",
        folder.string());
  std::string text;
  for (const fs::path& experiment : found) text += experiment_status(experiment);
  return text;
}

void add_status_command(CLI::App& app, Action& action) {
  CLI::App* status = app.add_subcommand("status", "How far the experiments in a folder are");
  const auto folder = std::make_shared<std::string>("results");
  status->add_option("RESULTS", *folder, "results, or results/<experiment>")->capture_default_str();
  status->callback([&action, folder] {
    action = [folder] {
      fmt::print("{}", status_text(*folder));
      return 0;
    };
  });
}

}  // namespace qtrace::experiments
