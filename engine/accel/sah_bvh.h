// A hierarchy split where the surface area heuristic expects the least work.
#pragma once

#include "engine/accel/bvh.h"

namespace qtrace {

// Split where the surface area heuristic expects the least work (Wald 2007, "On fast Construction of
// SAH-based Bounding Volume Hierarchies": binned). The same whatever the number of threads.
// `leaf_size`: most triangles of a leaf, 1..15. Throws Error for a scene without triangles.
Bvh build_sah_bvh(const Scene& scene, std::uint32_t leaf_size);

}  // namespace qtrace
