// Everything that is wrong with a config, where a run would name the first and stop.
#pragma once

#include "experiments/config/experiment_config.h"

#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::experiments {

// One sentence for each key, or axis of the sweep, that is wrong by itself; where none is, or with `sets`,
// the first error of all together, as load_experiment() has it. Empty: the config is good, and `experiment`
// is it.
std::vector<std::string> config_errors(const std::filesystem::path& file,
                                       const std::vector<std::string>& sets, Experiment& experiment);

}  // namespace qtrace::experiments
