// How much room an experiment's files take, before there are any.
#pragma once

#include "experiments/config/experiment_config.h"
#include "experiments/reference/reference.h"
#include "experiments/study/experiment_inputs.h"
#include "experiments/study/plan.h"

#include <filesystem>

namespace qtrace::experiments {

// Estimates in bytes, on the high side: images are taken as if they did not compress.
double run_bytes(const RunConfig& config, const Scene& scene);  // a finished run's folder
double checkpoint_bytes(const RunConfig& config, const Scene& scene);
double reference_bytes(const ReferenceSpec& spec);

// Of what is left to do: runs, the largest checkpoint, and references that are missing.
double needed_bytes(const Experiment& experiment, const std::vector<Turn>& left,
                    const std::vector<ReferenceSpec>& references, const ExperimentInputs& inputs);

// Free for this user where `folder` is, or the nearest folder above that exists.
double free_bytes(const std::filesystem::path& folder);

std::string bytes_text(double bytes);  // "1.2 GB"

}  // namespace qtrace::experiments
