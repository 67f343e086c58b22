#include "engine/accel/bvh.h"
#include "engine/accel/traverse.h"
#include "engine/core/check.h"
#include "engine/scene/gltf.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace qtrace {
namespace {

class BvhOfSimple : public testing::TestWithParam<std::uint32_t> {
 protected:
  Scene scene_ = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  Bvh bvh_ = build_median_bvh(scene_, GetParam());
};

TEST_P(BvhOfSimple, HoldsEveryTriangleOnceInsideItsBoxes) {
  std::vector<std::uint32_t> order = bvh_.order;
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  ASSERT_EQ(order.size(), scene_.triangles.size());
  for (const BvhNode& node : bvh_.nodes) {
    EXPECT_LE(node.count, GetParam());
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      for (const glm::vec3& p : scene_.triangles[bvh_.order[i]].position) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_GE(p[axis], node.lo[axis]);
          EXPECT_LE(p[axis], node.hi[axis]);
        }
      }
    }
  }
}

// Whoever enters every box meets every leaf once and ends; whoever misses the root ends at once; links lead
// forward, so no walk can be endless.
TEST_P(BvhOfSimple, LinksLeadForwardThroughEveryLeaf) {
  std::size_t triangles = 0;
  std::uint32_t index = 0;
  while (index != kNoNode) {
    const BvhNode& node = bvh_.nodes.at(index);
    EXPECT_GT(node.miss, index);
    triangles += node.count;
    index = node.count == 0 ? index + 1 : node.miss;
  }
  EXPECT_EQ(triangles, scene_.triangles.size());
  EXPECT_EQ(bvh_.nodes[0].miss, kNoNode);
}

// A child lies in its parent's box: what the miss link of a node skips is what it encloses.
TEST_P(BvhOfSimple, ParentsEncloseWhatTheirMissLinkSkips) {
  for (std::uint32_t i = 0; i < bvh_.nodes.size(); ++i) {
    const BvhNode& node = bvh_.nodes[i];
    const auto end = node.miss == kNoNode ? static_cast<std::uint32_t>(bvh_.nodes.size()) : node.miss;
    if (node.count > 0) {
      EXPECT_EQ(end, i + 1);
    }
    for (std::uint32_t j = i + 1; j < end && j < i + 8; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(bvh_.nodes[j].lo[axis], node.lo[axis]);
        EXPECT_LE(bvh_.nodes[j].hi[axis], node.hi[axis]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(LeafSizes, BvhOfSimple, testing::Values(1U, 4U, 15U));

TEST(Bvh, SceneWithoutTrianglesIsRefused) { EXPECT_THROW(build_median_bvh(Scene{}, 4), Error); }

TEST(Bvh, CoincidentTrianglesStillSplit) {
  Scene scene;
  scene.triangles.assign(1000,
                         Triangle{{glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}, {}, {}, 0, 0});
  const Bvh bvh = build_median_bvh(scene, 4);
  EXPECT_TRUE(closest_hit(scene, bvh, {glm::dvec3(0.2, 0.2, -1), glm::dvec3(0, 0, 1)}));
  for (const BvhNode& node : bvh.nodes) EXPECT_LE(node.count, 4U);
}

}  // namespace
}  // namespace qtrace
