// What identifies a scene's content.
#pragma once

#include "engine/scene/scene.h"

#include <string>

namespace qtrace::experiments {

// Of all that rendering reads: triangles, materials, objects, camera. Names and the file's encoding do not
// count.
std::string scene_hash(const Scene& scene);

}  // namespace qtrace::experiments
