// A hierarchy split at medians: the design of Goswami 2020.
#pragma once

#include "engine/accel/bvh.h"

namespace qtrace {

// Goswami 2020, section 4.1: split at the median of the triangles' centres along the longest axis.
// `leaf_size`: most triangles of a leaf, 1..15. Throws Error for a scene without triangles.
Bvh build_median_bvh(const Scene& scene, std::uint32_t leaf_size);

}  // namespace qtrace
