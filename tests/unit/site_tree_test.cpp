// Sites in tree order: what the search on the device takes for granted.
#include "engine/cells/site_tree.h"
#include "engine/scene/gltf.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <tuple>

namespace qtrace {
namespace {

// The left subtree holds no coordinate above its node's, the right one none below.
void expect_split(std::span<const CellSite> tree, std::span<const SplitDimension> dimensions, std::size_t node,
                  std::size_t below, bool is_left) {
  if (below >= tree.size()) return;
  const SplitDimension k = dimensions[node];
  if (is_left) {
    EXPECT_LE(coordinate(tree[below], k), coordinate(tree[node], k)) << "node " << below << " under " << node;
  } else {
    EXPECT_GE(coordinate(tree[below], k), coordinate(tree[node], k)) << "node " << below << " under " << node;
  }
  expect_split(tree, dimensions, node, 2 * below + 1, is_left);
  expect_split(tree, dimensions, node, 2 * below + 2, is_left);
}

void expect_trees(const CellSites& cells, const std::vector<SplitDimension>& dimensions) {
  ASSERT_EQ(dimensions.size(), cells.sites.size());
  for (std::size_t o = 0; o + 1 < cells.first.size(); ++o) {
    const std::size_t count = cells.first[o + 1] - cells.first[o];
    const auto tree = std::span(cells.sites).subspan(cells.first[o], count);
    const auto split = std::span(dimensions).subspan(cells.first[o], count);
    for (std::size_t node = 0; node < count; ++node) {
      EXPECT_LT(split[node], 6U);
      expect_split(tree, split, node, 2 * node + 1, true);
      expect_split(tree, split, node, 2 * node + 2, false);
    }
  }
}

auto as_tuple(const CellSite& s) {
  return std::tuple(s.position.x, s.position.y, s.position.z, s.normal.x, s.normal.y, s.normal.z);
}

// Every object keeps the sites that it had.
void expect_same_sites(CellSites before, CellSites after) {
  ASSERT_EQ(before.first, after.first);
  for (std::size_t o = 0; o + 1 < before.first.size(); ++o) {
    for (CellSites* cells : {&before, &after}) {
      std::ranges::sort(cells->sites.begin() + cells->first[o], cells->sites.begin() + cells->first[o + 1], {},
                        as_tuple);
    }
  }
  EXPECT_TRUE(std::ranges::equal(before.sites, after.sites, {}, as_tuple, as_tuple));
}

TEST(SiteTree, SplitsAtEveryNodeAndKeepsTheSites) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  for (const int count : {1, 2, 3, 4, 7, 8, 100, 1000}) {
    for (const double threshold : {-1.0, 0.5, 0.866, 0.99}) {
      SCOPED_TRACE(testing::Message() << count << " sites, threshold " << threshold);
      RlSettings settings;
      settings.sites_per_object = count;
      const CellSites before = place_sites(scene, settings);
      CellSites after = before;
      const std::vector<SplitDimension> dimensions = order_as_trees(after, threshold);
      expect_trees(after, dimensions);
      expect_same_sites(before, after);
    }
  }
}

// Equal coordinates may stand on either side, and objects without sites in between.
TEST(SiteTree, TakesEqualSitesAndEmptyObjects) {
  std::mt19937 random(5);
  CellSites cells;
  for (int i = 0; i < 61; ++i) {
    const auto step = [&] { return static_cast<float>(random() % 3); };
    cells.sites.push_back({{step(), step(), 0}, {0, 0, 1}});
  }
  cells.first = {0, 0, 1, 31, 31, 61};
  const CellSites before = cells;
  expect_trees(cells, order_as_trees(cells, 0.866));
  expect_same_sites(before, cells);
}

TEST(SiteTree, SplitsNormalsFirstWhereTheyDifferByMoreThanTheThresholdReaches) {
  CellSites cells;
  for (int i = 0; i < 31; ++i) {
    const float angle = 0.1F * static_cast<float>(i);
    cells.sites.push_back({{static_cast<float>(i), 0, 0}, {0, std::cos(angle), std::sin(angle)}});
  }
  cells.first = {0, 31};
  CellSites strict = cells;
  EXPECT_EQ(order_as_trees(strict, 0.866)[0], 4U);
  EXPECT_EQ(order_as_trees(cells, -1)[0], 0U);
}

}  // namespace
}  // namespace qtrace
