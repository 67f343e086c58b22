// One run: frames are rendered and timed from outside, snapshots measured, everything written.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/records/records.h"
#include "experiments/reference/reference.h"
#include "experiments/run/run_files.h"
#include "experiments/run/run_inputs.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/stopper.h"
#include "experiments/runtime/watchdog.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace qtrace::experiments {

std::unique_ptr<RunFiles> make_run_files(const std::filesystem::path& folder, const ExrMetadata& metadata,
                                         FileQueue& files);

using GiveUp = std::function<void(const std::string& why)>;

struct RunJob {
  const gpu::Context& context;
  const Experiment& experiment;
  const Run& run;
  const RunInputs& inputs;
  std::function<std::shared_ptr<const Reference>()> get_reference;
  std::filesystem::path folder;      // made here
  FileQueue& files;                  // what writes into it
  std::string label;                 // for the progress line
  const Stopper* stopper = nullptr;  // null: the run is never interrupted
  int until = 0;                     // a frame to stop after, to go on later; 0: the last
  Watchdog* watchdog = nullptr;      // null: frames may take any time
  // Called on the watchdog's thread when a frame has taken too long and the run's files say so; shall not
  // return.
  GiveUp give_up = {};
  std::function<std::unique_ptr<RunFiles>(const std::filesystem::path&, const ExrMetadata&, FileQueue&)>
      make_files = make_run_files;
};

// Pixels times frames, the unit of progress.
double run_work(const RunConfig& config);

struct RunEnd {
  RunRecord record;
  std::optional<Stopped>
      stopped;  // why no other run should follow: by the stopper, or because the disk is full
};

// A finished, failed or partial run, which a checkpoint is kept of. What an earlier call left as a checkpoint
// is gone on with, to the same bits. Never throws for a run that fails: the record and, where it can be
// written, its manifest say why, and what was measured until then is written. Throws gpu::ContextLost, after
// which another call with a new context goes on.
RunEnd execute_run(const RunJob& job, Progress& progress);

// Why this run's image is black although nothing is wrong, or empty.
std::string light_warning(const LoadedScene& scene, const RunConfig& config);

}  // namespace qtrace::experiments
