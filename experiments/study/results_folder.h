// The folder of an experiment's results: who may write there, and whether what is there is of the same
// experiment.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/config/experiment_config.h"
#include "experiments/files/folder_lock.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/study/run_choices.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// All that decides an experiment's results, as its manifest has it: config, scenes, device, program.
Json identity_json(const Experiment& experiment, SceneStore& scenes, const gpu::DeviceInfo& device);

// What differs between the identities in two manifests, one phrase each; empty where results of both may
// stand side by side.
std::vector<std::string> identity_changes(const Json& earlier, const Json& now);

class ResultsFolder {
 public:
  // Makes the folder root/<experiment> and locks it: alone, or, as a shard, beside the other shards. Earlier
  // results that are not of this experiment are an error that says what changed and what can be done; with
  // `fresh` they are renamed to <experiment>.1, .2, ... and so are those that are.
  ResultsFolder(const Experiment& experiment, const Json& identity, const std::filesystem::path& root,
                const Shard& shard, bool fresh, Progress& progress);

  const std::filesystem::path& path() const { return path_; }

 private:
  void lock(const Shard& shard);

  std::filesystem::path path_;
  std::vector<FolderLock> locks_;
};

// The file whose lock says that a process is at work in the folder.
std::filesystem::path lock_file(const std::filesystem::path& folder);

}  // namespace qtrace::experiments
