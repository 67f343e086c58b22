#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <vector>

namespace qtrace::gpu {

// Splits triangles (indices in the scene, increasing) into those that belong to one object and hang together:
// they share vertices by position. In the order of their first triangles.
std::vector<std::vector<std::uint32_t>> connected_groups(const Scene& scene,
                                                         const std::vector<std::uint32_t>& triangles);

}  // namespace qtrace::gpu
