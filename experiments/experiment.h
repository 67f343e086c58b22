// A whole experiment: all runs of a config, and the files about all of them.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/experiment_config.h"
#include "experiments/progress.h"
#include "experiments/scene_store.h"

#include <filesystem>
#include <optional>
#include <string>

namespace qtrace::experiments {

// Loads every scene that a run needs and puts out what is strange about them. Throws Error that names the
// config, the run and the file.
void load_scenes(const Experiment& experiment, SceneStore& scenes, Progress& progress);

// The runs as text: id, scene, size, frames and method of each, then the references that they need.
std::string describe_runs(const Experiment& experiment, SceneStore& scenes,
                          const std::filesystem::path& results_root);

// Renames an existing folder to the first free name of folder.1, folder.2, ... and returns that name.
std::optional<std::filesystem::path> move_aside(const std::filesystem::path& folder);

// Throws Error that names the first run that the device cannot do.
void check_device(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes);

// Places of the runs in the order of execution: the first seed of every cell, then the second of every cell,
// so that a machine that slows down or speeds up treats all cells alike.
std::vector<std::size_t> execution_order(const Experiment& experiment);

// Runs everything and writes results_root/<name>; earlier results of that name are moved aside. Prints the
// table. Failed runs do not stop the others. Returns whether all runs finished
// and none failed what was expected of it.
bool run_experiment(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes,
                    const std::filesystem::path& results_root, Progress& progress);

}  // namespace qtrace::experiments
