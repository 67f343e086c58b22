// What identifies a scene's content.
#pragma once

#include "engine/scene/scene.h"

#include <string>

namespace qtrace::experiments {

// Of all that rendering reads: triangles, materials, objects, camera, the image around it. Names and the
// files' encoding do not count.
std::string scene_hash(const Scene& scene);

}  // namespace qtrace::experiments
