// What identifies a run's settings.
#pragma once

#include "experiments/config/config.h"

#include <string>

namespace qtrace::experiments {

// Of the resolved config with the scene's content in the place of its path, and without the experiment's
// name and what is saved, which change no pixel. Stands still while knobs are added: see KnobInfo::implied.
std::string config_hash(const RunConfig& config, const std::string& scene_hash);

}  // namespace qtrace::experiments
