// Sites in tree order: what the search on the device takes for granted.
#include "engine/cells/site_tree.h"
#include "engine/gltf/load_gltf.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <tuple>

namespace qtrace {
namespace {

// All of a subtree: on one side of `node`, and within its bounds of normals.
void expect_below(std::span<const CellSite> tree, std::span<const SiteNode> nodes, std::size_t node,
                  std::size_t below, bool is_left) {
  if (below >= tree.size()) return;
  SCOPED_TRACE(testing::Message() << "node " << below << " under " << node);
  const int axis = nodes[node].axis;
  if (is_left) {
    EXPECT_LE(tree[below].position[axis], tree[node].position[axis]);
  } else {
    EXPECT_GE(tree[below].position[axis], tree[node].position[axis]);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(tree[below].normal[k], nodes[node].lo_normal[k]);
    EXPECT_LE(tree[below].normal[k], nodes[node].hi_normal[k]);
  }
  expect_below(tree, nodes, node, 2 * below + 1, is_left);
  expect_below(tree, nodes, node, 2 * below + 2, is_left);
}

void expect_trees(const CellSites& cells, const std::vector<SiteNode>& nodes) {
  ASSERT_EQ(nodes.size(), cells.sites.size());
  for (std::size_t o = 0; o + 1 < cells.first.size(); ++o) {
    const std::size_t count = cells.first[o + 1] - cells.first[o];
    const auto tree = std::span(cells.sites).subspan(cells.first[o], count);
    const auto below = std::span(nodes).subspan(cells.first[o], count);
    for (std::size_t node = 0; node < count; ++node) {
      expect_below(tree, below, node, 2 * node + 1, true);
      expect_below(tree, below, node, 2 * node + 2, false);
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
      std::ranges::sort(cells->sites.begin() + cells->first[o], cells->sites.begin() + cells->first[o + 1],
                        {}, as_tuple);
    }
  }
  EXPECT_TRUE(std::ranges::equal(before.sites, after.sites, {}, as_tuple, as_tuple));
}

TEST(SiteTree, SplitsAtEveryNodeAndKeepsTheSites) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  for (const int count : {1, 2, 3, 4, 7, 8, 100, 500}) {
    SCOPED_TRACE(testing::Message() << count << " sites");
    RlSettings settings = test::goswami_table();
    settings.sites_per_object = count;
    const CellSites before = place_sites(scene, settings);
    CellSites after = before;
    expect_trees(after, order_as_trees(after));
    expect_same_sites(before, after);
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
  expect_trees(cells, order_as_trees(cells));
  expect_same_sites(before, cells);
}

}  // namespace
}  // namespace qtrace
