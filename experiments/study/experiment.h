// A whole experiment: all runs of a config, and the files about all of them.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/config/experiment_config.h"
#include "experiments/runtime/progress.h"
#include "experiments/study/results_folder.h"
#include "experiments/run/run.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/runtime/stopper.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// What of an experiment is done, and how.
struct RunChoices {
  std::filesystem::path root = "results";
  Shard shard;
  std::string only;              // pattern of run ids with * and ?; empty: all
  bool fresh = false;            // earlier results are put aside instead of gone on with
  bool keep_failed = false;      // failed runs are not tried again
  bool fail_fast = false;        // the first failed run ends the work
  bool references_only = false;  // renders references alone
  bool merge = false;            // renders nothing: writes the files about the runs that are there
};

// Loads every scene that a run needs and puts out what is strange about them. Throws Error that names the
// config, the run and the file.
void load_scenes(const Experiment& experiment, SceneStore& scenes, Progress& progress);

// Throws Error that names the first run that the device cannot do.
void check_device(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes);

// Does what is missing of the chosen runs in root/<name> and prints the table; what is there of an earlier
// call stays as it is. Failed runs do not stop the others. Returns whether all chosen runs are finished and
// none failed what was expected of it. `give_up`: see RunJob. Throws Error before anything is done, and
// Stopped.
bool run_experiment(const Experiment& experiment, gpu::Context& context, SceneStore& scenes,
                    const RunChoices& choices, const Stopper& stopper, const GiveUp& give_up,
                    Progress& progress);

}  // namespace qtrace::experiments
