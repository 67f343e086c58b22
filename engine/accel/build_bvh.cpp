#include "engine/accel/build_bvh.h"

#include "engine/accel/median_bvh.h"
#include "engine/accel/sah_bvh.h"

namespace qtrace {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;

}  // namespace

Bvh build_bvh(const Scene& scene, BvhKind kind) {
  return kind == BvhKind::sah ? build_sah_bvh(scene, kLeafTriangles)
                              : build_median_bvh(scene, kLeafTriangles);
}

}  // namespace qtrace
