// A whole experiment: all runs of a config, and the files about all of them.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/config/experiment_config.h"
#include "experiments/run/run.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/runtime/stopper.h"
#include "experiments/study/run_choices.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// Reads these configs, each with the same `--set`s, and loads their scenes. Throws Error for what is wrong
// with one of them, and where two would share a folder of results.
std::vector<Experiment> load_experiments(const std::vector<std::string>& files,
                                         const std::vector<std::string>& sets, SceneStore& scenes,
                                         Progress& progress);

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
