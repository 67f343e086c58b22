#pragma once

#include "engine/scene/scene.h"

#include <cstdint>

namespace qtrace {

// Throws Error where a hierarchy cannot be built: for a scene without triangles, or leaves of none or
// over 15.
void check_buildable(const Scene& scene, std::uint32_t leaf_size);

}  // namespace qtrace
