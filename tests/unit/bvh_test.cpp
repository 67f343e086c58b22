#include "engine/accel/bvh.h"
#include "engine/accel/median_bvh.h"
#include "engine/accel/sah_bvh.h"
#include "engine/accel/traverse.h"
#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace qtrace {
namespace {

Bvh build(const Scene& scene, BvhKind kind, std::uint32_t leaf_size) {
  return kind == BvhKind::sah ? build_sah_bvh(scene, leaf_size) : build_median_bvh(scene, leaf_size);
}

class BvhOfSimple : public testing::TestWithParam<std::tuple<BvhKind, std::uint32_t>> {
 protected:
  std::uint32_t leaf_size_ = std::get<1>(GetParam());
  Scene scene_ = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  Bvh bvh_ = build(scene_, std::get<0>(GetParam()), leaf_size_);
};

TEST_P(BvhOfSimple, HoldsEveryTriangleOnceInsideItsBoxes) {
  std::vector<std::uint32_t> order = bvh_.order;
  std::ranges::sort(order);
  for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
  ASSERT_EQ(order.size(), scene_.triangles.size());
  for (const BvhNode& node : bvh_.nodes) {
    EXPECT_LE(node.count, leaf_size_);
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

INSTANTIATE_TEST_SUITE_P(KindsAndLeafSizes, BvhOfSimple,
                         testing::Combine(testing::Values(BvhKind::sah, BvhKind::threaded),
                                          testing::Values(1U, 4U, 15U)));

class BvhKinds : public testing::TestWithParam<BvhKind> {};

TEST_P(BvhKinds, OfAnEmptySceneNothingIsHit) {
  const Scene nothing;
  const Bvh bvh = build(nothing, GetParam(), 4);
  EXPECT_EQ(bvh.kind, GetParam());
  EXPECT_FALSE(closest_hit(nothing, bvh, {{0, 0, 1}, {0, 0, -1}}).has_value());
}

Triangle triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return {{a, b, c}, {}, {}, 0, 0};
}

TEST_P(BvhKinds, CoincidentTrianglesStillSplit) {
  Scene scene;
  scene.triangles.assign(1000, triangle(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  const Bvh bvh = build(scene, GetParam(), 4);
  EXPECT_TRUE(closest_hit(scene, bvh, {glm::dvec3(0.2, 0.2, -1), glm::dvec3(0, 0, 1)}));
  for (const BvhNode& node : bvh.nodes) EXPECT_LE(node.count, 4U);
}

int depth(const Bvh& bvh, std::uint32_t node) {
  if (bvh.nodes[node].count > 0) return 0;
  return 1 + std::max(depth(bvh, node + 1), depth(bvh, bvh.nodes[node + 1].miss));
}

// Each triangle is twice as far and as large as the last, so that the best split cuts off the last one: a
// chain.
TEST_P(BvhKinds, NoTreeIsDeeperThanTheStackOfShaders) {
  Scene scene;
  for (int i = 0; i < 220; ++i) {
    const float x = std::ldexp(1.0F, i - 110);
    scene.triangles.push_back(triangle({x, 0, 0}, {1.1F * x, 0, 0}, {x, 0.1F * x, 0}));
  }
  const Bvh bvh = build(scene, GetParam(), 1);
  EXPECT_LE(depth(bvh, 0), kMaxBvhDepth);
  EXPECT_EQ(bvh.nodes.size(), 2 * scene.triangles.size() - 1);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BvhKinds, testing::Values(BvhKind::sah, BvhKind::threaded));

// Of a ray that meets the root: the chance of meeting a node is its share of the root's surface.
double expected_work(const Bvh& bvh) {
  const auto area = [](const BvhNode& n) {
    const glm::dvec3 size = glm::dvec3(n.hi) - glm::dvec3(n.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
  };
  double work = 0;
  for (const BvhNode& n : bvh.nodes) work += area(n) * (1 + n.count);
  return work / area(bvh.nodes[0]);
}

TEST(SahBvh, ExpectsLessWorkThanMedians) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  EXPECT_LT(expected_work(build_sah_bvh(scene, 4)), 0.5 * expected_work(build_median_bvh(scene, 4)));
}

// Two clusters of unlike size, far apart: the heuristic cuts between them, medians cut the larger one.
TEST(SahBvh, CutsWhereTheSurfaceIsLeast) {
  Scene scene;
  for (int i = 0; i < 10; ++i) {
    const float x = static_cast<float>(i) + (i < 2 ? 0.0F : 100.0F);
    scene.triangles.push_back(triangle({x, 0, 0}, {x + 0.5F, 0, 0}, {x, 1, 1}));
  }
  const Bvh bvh = build_sah_bvh(scene, 2);
  const BvhNode& first = bvh.nodes[1];
  const BvhNode& second = bvh.nodes[first.miss];
  EXPECT_EQ(std::min(first.hi.x, second.hi.x), 1.5F);
  EXPECT_EQ(std::max(first.lo.x, second.lo.x), 102.0F);
}

}  // namespace
}  // namespace qtrace
