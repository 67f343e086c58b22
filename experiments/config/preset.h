// Presets: settings of a run in a file of their own, which a config names and overrides.
#pragma once

#include "experiments/files/json.h"

#include <filesystem>

namespace qtrace::experiments {

// `config` over the settings of the file that its key 'preset' names, relative to `file`, the config's own
// place; as it is where it names none. Throws Error that names the preset's file.
Json with_preset(const Json& config, const std::filesystem::path& file);

}  // namespace qtrace::experiments
