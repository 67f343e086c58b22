// The grid of 16-bit boxes: every box encloses its node's, in the arithmetic that the shader uses.
#include "engine/accel/build_bvh.h"
#include "engine/device_scene/wide_nodes.h"
#include "engine/gltf/load_gltf.h"

#include <gtest/gtest.h>

#include <array>

namespace qtrace::gpu {
namespace {

struct Box {
  glm::dvec3 lo;
  glm::dvec3 hi;
};

Box unpacked(const NodeGrid& grid, const uvec3& corners) {
  Box box{};
  for (int k = 0; k < 3; ++k) {
    box.lo[k] = grid.lo[k] + static_cast<double>(corners[k] & 0xffffU) / double{grid.scale[k]};
    box.hi[k] = grid.lo[k] + static_cast<double>(corners[k] >> 16) / double{grid.scale[k]};
  }
  return box;
}

// Beyond the node's box by what rounding can move a plane in the shader's test, with the eye `away` scene
// sizes off.
void expect_enclosed(const NodeGrid& grid, const uvec3& corners, const BvhNode& node, double away) {
  constexpr double kMoved = 6 * 65536.0 / 16777216.0;
  const Box box = unpacked(grid, corners);
  for (int k = 0; k < 3; ++k) {
    const double margin = kMoved * (1 + away) / double{grid.scale[k]};
    EXPECT_LE(box.lo[k], node.lo[k] - margin);
    EXPECT_GE(box.hi[k], node.hi[k] + margin);
    EXPECT_GE(box.lo[k], node.lo[k] - 3 * (1 + away) / double{grid.scale[k]}) << "needlessly large";
  }
}

void expect_all_enclosed(const Bvh& bvh, const glm::vec3& eye, double away) {
  const WideNodes wide = pack_wide_nodes(bvh, eye);
  std::size_t inner = 0;
  for (std::size_t i = 0; i < bvh.nodes.size(); ++i) {
    if (bvh.nodes[i].count > 0) continue;
    const BvhNode& first = bvh.nodes[i + 1];
    const BvhNode& second = bvh.nodes[first.miss];
    const WideNode& node = wide.nodes.at(inner++);
    expect_enclosed(wide.grid, uvec3(node.a), first, away);
    expect_enclosed(wide.grid, uvec3(node.a.w, node.b.x, node.b.y), second, away);
    if (second.count > 0) {
      EXPECT_EQ(node.b.w, LEAF_LINK | (second.first << LEAF_BITS) | second.count);
    }
  }
  EXPECT_EQ(inner, wide.nodes.size());
}

TEST(WideNodes, EncloseTheirBoxes) {
  const Bvh bvh = build_bvh(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb"), BvhKind::sah);
  const glm::vec3 size = bvh.nodes[0].hi - bvh.nodes[0].lo;
  expect_all_enclosed(bvh, bvh.nodes[0].lo, 0);
  expect_all_enclosed(bvh, bvh.nodes[0].lo - 100.0F * size, 100);
}

TEST(WideNodes, FlatScenesHaveAGridToo) {
  Bvh bvh{BvhKind::sah, {}, {0, 1}};
  bvh.nodes = {{{0, 5, 0}, {1, 5, 1}, kNoNode, 0, 0},
               {{0, 5, 0}, {0.5F, 5, 1}, 2, 0, 1},
               {{0.5F, 5, 0}, {1, 5, 1}, kNoNode, 1, 1}};
  expect_all_enclosed(bvh, {0.5F, 5, 0.5F}, 0);
}

// The root is a leaf: both children are, the second one where no ray finds more.
TEST(WideNodes, OneLeafStandsTwice) {
  Bvh bvh{BvhKind::sah, {{{0, 0, 0}, {1, 1, 1}, kNoNode, 0, 3}}, {0, 1, 2}};
  const WideNodes wide = pack_wide_nodes(bvh, glm::vec3(0));
  ASSERT_EQ(wide.nodes.size(), 1U);
  EXPECT_EQ(wide.nodes[0].b.z, LEAF_LINK | 3U);
  EXPECT_EQ(wide.nodes[0].b.w, LEAF_LINK | 3U);
  expect_enclosed(wide.grid, uvec3(wide.nodes[0].a), bvh.nodes[0], 0);
}

}  // namespace
}  // namespace qtrace::gpu
