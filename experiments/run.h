// One run: frames are rendered and timed from outside, snapshots measured, everything written.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/progress.h"
#include "experiments/records.h"
#include "experiments/reference.h"
#include "experiments/run_files.h"
#include "experiments/scene_store.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace qtrace::experiments {

std::unique_ptr<RunFiles> make_run_files(const std::filesystem::path& folder, const ExrMetadata& metadata);

struct RunJob {
  const gpu::Context& context;
  const Experiment& experiment;
  const Run& run;
  const LoadedScene& scene;
  const std::string& reference_scene_hash;  // of what its reference shows
  std::function<std::shared_ptr<const Reference>()> get_reference;
  std::filesystem::path folder;  // made here
  std::string label;             // for the progress line
  std::function<std::unique_ptr<RunFiles>(const std::filesystem::path&, const ExrMetadata&)> make_files =
      make_run_files;
};

// Pixels times frames, the unit of progress.
double run_work(const RunConfig& config);

// Never throws for a run that fails: the record and, where it can be written, its manifest say why, and what
// was measured until then is written.
RunRecord execute_run(const RunJob& job, Progress& progress);

// Why this run's image is black although nothing is wrong, or empty.
std::string light_warning(const LoadedScene& scene, const RunConfig& config);

}  // namespace qtrace::experiments
