// What is the same for every way to build a hierarchy.
#pragma once

#include "engine/accel/bvh.h"

#include <cstdint>

namespace qtrace {

// Throws Error where leaves could hold no triangle, or over 15.
void check_leaf_size(std::uint32_t leaf_size);

// Of a scene without triangles: one leaf that no ray hits anything in.
Bvh empty_bvh(BvhKind kind);

}  // namespace qtrace
