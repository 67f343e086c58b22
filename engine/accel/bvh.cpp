#include "engine/accel/bvh.h"

#include "engine/core/check.h"

namespace qtrace {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;

}  // namespace

void check_buildable(const Scene& scene, std::uint32_t leaf_size) {
  check(leaf_size >= 1 && leaf_size <= 15, "BVH leaf size {} is outside 1..15", leaf_size);
  check(!scene.triangles.empty(), "scene {} has no triangles: there is nothing to render", scene.name);
}

Bvh build_bvh(const Scene& scene, BvhKind kind) {
  return kind == BvhKind::sah ? build_sah_bvh(scene, kLeafTriangles)
                              : build_median_bvh(scene, kLeafTriangles);
}

}  // namespace qtrace
