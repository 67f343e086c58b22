// A run's folder, read back: what it was told, and what its table had learned.
#pragma once

#include "experiments/config/config.h"
#include "experiments/run/saved_table.h"
#include "experiments/runtime/scene_store.h"

#include <filesystem>
#include <optional>
#include <string>

namespace qtrace::experiments {

struct InspectedRun {
  std::filesystem::path folder;
  RunConfig config;
  std::string config_hash;
  LoadedScene scene;
  SavedTable table;
};

// Throws Error: not the folder of a run, no direction bins, no table of this frame (none: the last one), or a
// scene that is gone or has changed since.
InspectedRun read_inspected_run(const std::filesystem::path& folder, std::optional<int> frame);

}  // namespace qtrace::experiments
