#include "experiments/study/results_folder.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/runtime/manifest.h"

#include <algorithm>
#include <map>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostChanges = 4;  // named in a message

Json without_execution(Json config) {
  for (const std::string_view key : kKeysOfExecution) config.erase(std::string(key));
  return config;
}

std::string shown(const Json& value) {
  constexpr std::size_t kLongest = 60;
  const std::string text = show(value);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

// What is no object with members, by its dotted path. Names on the way may hold dots, too, so that nothing
// can be found by such a path.
void add_leaves(const Json& object, const std::string& prefix, std::map<std::string, Json>& leaves) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object() && !value.empty()) {
      add_leaves(value, prefix + key + '.', leaves);
    } else {
      leaves[prefix + key] = value;
    }
  }
}

void add_config_changes(const Json& before, const Json& now, std::vector<std::string>& changes) {
  std::map<std::string, Json> earlier, later;
  add_leaves(before, "", earlier);
  add_leaves(now, "", later);
  for (const auto& [path, was] : earlier) {
    const auto is = later.find(path);
    if (is == later.end()) {
      changes.push_back(fmt::format("key '{}' was {} and is absent", path, shown(was)));
    } else if (is->second != was) {
      changes.push_back(fmt::format("key '{}' was {} and is {}", path, shown(was), shown(is->second)));
    }
  }
  for (const auto& [path, is] : later) {
    if (!earlier.contains(path))
      changes.push_back(fmt::format("key '{}' was absent and is {}", path, shown(is)));
  }
  if (changes.empty() && canonical_text(before) != canonical_text(now)) {
    changes.emplace_back("the config differs");
  }
}

// `what`: of the device or the program.
void add_part_changes(const char* part, const char* what, const Json& earlier, const Json& now,
                      std::vector<std::string>& changes) {
  const Json before = earlier.value(part, Json::object());
  for (const auto& [name, value] : now.at(part).items()) {
    const auto was = before.find(name);
    if (was != before.end() && *was == value) continue;
    changes.push_back(fmt::format("{} '{}' was {} and is {}", what, name,
                                  was == before.end() ? "absent" : shown(*was), shown(value)));
  }
}

// The hashes of the scenes would tell nobody anything.
void add_scene_changes(const Json& earlier, const Json& now, std::vector<std::string>& changes) {
  const Json before = earlier.value("scenes", Json::object());
  for (const auto& [name, hash] : now.at("scenes").items()) {
    const auto was = before.find(name);
    if (was == before.end()) {
      changes.push_back(fmt::format("scene '{}' is new", name));
    } else if (*was != hash) {
      changes.push_back(fmt::format("the content of scene '{}' has changed", name));
    }
  }
}

fs::path move_aside(const fs::path& folder) {
  int number = 1;
  fs::path aside;
  do {
    aside = folder.string() + '.' + std::to_string(number++);
  } while (fs::exists(aside));
  std::error_code error;
  fs::rename(folder, aside, error);
  check(!error, "{}: earlier results cannot be moved to {}: {}", folder.string(), aside.string(),
        error.message());
  return aside;
}

// Nothing where the folder holds no results yet.
std::optional<std::string> difference(const fs::path& folder, const Json& identity) {
  const fs::path manifest = folder / "manifest.json";
  if (!fs::exists(manifest)) return std::nullopt;
  std::vector<std::string> changes;
  try {
    changes = identity_changes(read_json_file(manifest), identity);
  } catch (const std::exception& error) {
    return error.what();
  }
  if (changes.empty()) return std::nullopt;
  const std::size_t named = std::min(changes.size(), kMostChanges);
  std::string text =
      fmt::format("{}", fmt::join(changes.begin(), changes.begin() + static_cast<long>(named), "; "));
  if (named < changes.size()) text += fmt::format("; and {} more changes", changes.size() - named);
  return text;
}

}  // namespace

Json identity_json(const Experiment& experiment, SceneStore& scenes, const gpu::DeviceInfo& device) {
  Json hashes = Json::object();
  for (const Run& run : experiment.runs) {
    const View view = view_of(run.config);
    const auto environment = experiment.environment_image(run);
    const std::string added = view_text(view) + environment_text(run.config.environment_image);
    for (const fs::path& file : {experiment.scene_file(run), experiment.reference_file(run)}) {
      const fs::path name = file.lexically_normal().lexically_relative(experiment.folder());
      hashes[name.string() + added] = scenes.load(file, view, environment).hash;
    }
  }
  return {{"config", experiment.config},
          {"scenes", std::move(hashes)},
          {"device", device_json(device)},
          {"program", program_json()}};
}

std::vector<std::string> identity_changes(const Json& earlier, const Json& now) {
  std::vector<std::string> changes;
  add_config_changes(without_execution(earlier.value("config", Json::object())),
                     without_execution(now.at("config")), changes);
  add_scene_changes(earlier, now, changes);
  add_part_changes("device", "the device's", earlier, now, changes);
  add_part_changes("program", "the program's", earlier, now, changes);
  return changes;
}

fs::path lock_file(const fs::path& folder) { return folder / ".lock"; }

ResultsFolder::ResultsFolder(const Experiment& experiment, const Json& identity, const fs::path& root,
                             const Shard& shard, bool fresh, Progress& progress)
    : path_(root / experiment.name) {
  make_folder(root);
  make_folder(path_);
  lock(shard);
  const bool has_results = fs::exists(path_ / "manifest.json");
  if (fresh && has_results) {
    const fs::path aside = move_aside(path_);
    locks_.clear();
    make_folder(path_);
    lock(shard);
    progress.note(fmt::format("{}: earlier results are kept as {}", path_.string(), aside.string()));
  } else if (const auto changes = difference(path_, identity)) {
    fail(
        "{}: holds results of something else: {}. To keep them and start anew, add --fresh, which renames "
        "them; to "
        "write elsewhere, --out FOLDER",
        path_.string(), *changes);
  }
  if (shard.is_whole()) remove_unfinished_files(path_);
}

void ResultsFolder::lock(const Shard& shard) {
  const auto kind = shard.is_whole() ? FolderLock::Kind::alone : FolderLock::Kind::shared;
  locks_.emplace_back(lock_file(path_), kind, path_.string());
  if (shard.is_whole()) return;
  locks_.emplace_back(path_ / fmt::format(".shard-{}.lock", shard.text()), FolderLock::Kind::alone,
                      fmt::format("{}, shard {} of {}", path_.string(), shard.index, shard.count));
}

}  // namespace qtrace::experiments
