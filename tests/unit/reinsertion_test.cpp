#include "engine/accel/reinsertion.h"
#include "engine/accel/bvh_tree.h"
#include "engine/accel/median_bvh.h"
#include "engine/accel/traverse.h"
#include "engine/gltf/load_gltf.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <random>

namespace qtrace {
namespace {

double surface(const BvhNode& n) {
  const glm::dvec3 size = glm::dvec3(n.hi) - glm::dvec3(n.lo);
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

double surface_of_all(const Bvh& bvh) {
  return std::accumulate(bvh.nodes.begin(), bvh.nodes.end(), 0.0,
                         [](double sum, const BvhNode& n) { return sum + surface(n); });
}

class Reinserted : public testing::Test {
 protected:
  Scene scene_ = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  Bvh before_ = build_median_bvh(scene_, 4);
  Bvh after_ = [this] {
    Bvh bvh = before_;
    reinsert_subtrees(bvh);
    return bvh;
  }();
};

TEST_F(Reinserted, BoxesAreSmaller) { EXPECT_LT(surface_of_all(after_), 0.8 * surface_of_all(before_)); }

TEST_F(Reinserted, TrianglesAreThereOnceAndInTheirLeaves) {
  EXPECT_EQ(after_.nodes.size(), before_.nodes.size());
  std::vector<std::uint32_t> order = after_.order;
  std::ranges::sort(order);
  std::vector<std::uint32_t> all(scene_.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(order, all);
  std::uint32_t next = 0;
  for (const BvhNode& node : after_.nodes) {
    if (node.count == 0) continue;
    EXPECT_EQ(node.first, next);  // leaf by leaf
    next += node.count;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      for (const glm::vec3& p : scene_.triangles[after_.order[node.first + i]].position) {
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, node.lo)) && glm::all(glm::lessThanEqual(p, node.hi)));
      }
    }
  }
}

TEST_F(Reinserted, RaysFindTheSame) {
  std::mt19937 random(2);
  std::normal_distribution<double> gauss;
  const auto vector = [&] { return glm::dvec3(gauss(random), gauss(random), gauss(random)); };
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{glm::dvec3(scene_.camera.world_from_camera[3]), glm::normalize(vector())};
    const auto a = closest_hit(scene_, before_, ray);
    const auto b = closest_hit(scene_, after_, ray);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    EXPECT_EQ(a->t, b->t);
    ++hits;
  }
  EXPECT_GT(hits, 500);
}

TEST_F(Reinserted, SmallerChildComesFirst) {
  for (std::size_t i = 0; i < after_.nodes.size(); ++i) {
    if (after_.nodes[i].count > 0) continue;
    const BvhNode& first = after_.nodes[i + 1];
    EXPECT_LE(surface(first), surface(after_.nodes[first.miss]) * (1 + 1e-6));
  }
}

TEST_F(Reinserted, AgainItIsTheSame) {
  Bvh again = before_;
  reinsert_subtrees(again);
  EXPECT_EQ(again.order, after_.order);
}

// Leaves at 0, 10, 1 and 11 along a line, in the pairs (0, 10) and (1, 11): one move makes it (0, 1) and (10,
// 11), or as good a tree.
TEST(Reinsertion, MovesWhatIsMisplaced) {
  Bvh bvh;
  const auto leaf = [&](float x, std::uint32_t miss) {
    const auto triangle = static_cast<std::uint32_t>(bvh.order.size());
    bvh.order.push_back(triangle);
    bvh.nodes.push_back({{x, 0, 0}, {x + 1, 1, 1}, miss, triangle, 1});
  };
  const auto inner = [&](float lo, float hi, std::uint32_t miss) {
    bvh.nodes.push_back({{lo, 0, 0}, {hi, 1, 1}, miss, 0, 0});
  };
  inner(0, 12, kNoNode);
  inner(0, 11, 4);
  leaf(0, 3);
  leaf(10, 4);
  inner(1, 12, kNoNode);
  leaf(1, 6);
  leaf(11, kNoNode);
  const SubtreeMove move = BvhTree(bvh).best_move(2);
  EXPECT_EQ(move.beside, 5U);  // 0 beside 1
  // Taken out of a box of 11, whose node goes; put into one of 2 within one that grows from 11 to 12 along
  // the line: halves of surfaces are 2 x + x + 1... = 2 x + 1 for a length of x.
  EXPECT_FLOAT_EQ(move.gain, (2 * 11 + 1) - (2 * 2 + 1) - (2 * 12 - 2 * 11));
  reinsert_subtrees(bvh);
  EXPECT_LE(surface_of_all(bvh), (2 * 12 + 1) + 2 * (2 * 2 + 1) + 4 * 3 + 1e-6);
}

}  // namespace
}  // namespace qtrace
