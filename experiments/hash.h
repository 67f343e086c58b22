// Content hashes: XXH3 with 128 bits, as 32 hexadecimal digits.
#pragma once

#include "engine/scene/scene.h"
#include "experiments/config.h"
#include "experiments/json.h"

#include <string>
#include <string_view>

namespace qtrace::experiments {

std::string hash_text(std::string_view text);

// Of all that rendering reads: triangles, materials, objects, camera. Names and the file's encoding do not
// count.
std::string scene_hash(const Scene& scene);

// Of the resolved config with the scene's content in the place of its path, and without the experiment's
// name and what is saved, which change no pixel.
std::string config_hash(const RunConfig& config, const std::string& scene_hash);

}  // namespace qtrace::experiments
