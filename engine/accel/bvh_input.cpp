#include "engine/accel/bvh_input.h"

#include "engine/core/check.h"

namespace qtrace {

void check_buildable(const Scene& scene, std::uint32_t leaf_size) {
  check(leaf_size >= 1 && leaf_size <= 15, "BVH leaf size {} is outside 1..15", leaf_size);
  check(!scene.triangles.empty(), "scene {} has no triangles: there is nothing to render", scene.name);
}

}  // namespace qtrace
