#include "engine/cells/grid.h"
#include "engine/gltf/load_gltf.h"
#include "engine/scene/analytic.h"

#include <gtest/gtest.h>
#include <glm/common.hpp>

#include <algorithm>
#include <set>
#include <tuple>

namespace qtrace {
namespace {

Scene one_triangle(const std::array<glm::vec3, 3>& position, const std::array<glm::vec3, 3>& normal) {
  Scene scene;
  scene.triangles.push_back({position, normal, {}, 0, 0});
  scene.objects.push_back({"triangle", 0, 1, false});
  return scene;
}

using Key = std::tuple<float, float, float, float, float, float>;

std::set<Key> keys(const CellGrid& grid) {
  std::set<Key> found;
  for (const GridCell& c : grid.cells) {
    found.insert({c.centre.x, c.centre.y, c.centre.z, c.normal.x, c.normal.y, c.normal.z});
  }
  return found;
}

// 2 x 3 in boxes of 3 / 4: three by four of them, seen from either side.
TEST(CellGrid, CoversAQuad) {
  Scene scene;
  add_quad(scene, {1, 2, 5}, {2, 0, 0}, {0, 3, 0}, 0);
  const CellGrid grid = build_grid(scene, 4);
  EXPECT_EQ(grid.frame.boxes, glm::uvec3(3, 4, 1));
  EXPECT_EQ(grid.frame.origin, glm::vec3(1, 2, 5));
  EXPECT_FLOAT_EQ(grid.frame.boxes_per_unit, 4.0F / 3);
  ASSERT_EQ(grid.cells.size(), 24U);
  EXPECT_EQ(grid.rows.size(), 3U * 4 * 6);
  for (const GridCell& cell : grid.cells) EXPECT_EQ(glm::abs(cell.normal), glm::vec3(0, 0, 1));
  EXPECT_EQ(grid.cells[0].centre, glm::vec3(1.375F, 2.375F, 5.375F));
  EXPECT_EQ(grid.cells[0].normal, glm::vec3(0, 0, 1));
  EXPECT_EQ(grid.cells[1].normal, glm::vec3(0, 0, -1));
}

TEST(CellGrid, NumbersItsRowsOnceEach) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  const CellGrid grid = build_grid(scene, 16);
  std::vector<std::uint32_t> rows;
  std::ranges::copy_if(grid.rows, std::back_inserter(rows), [](std::uint32_t r) { return r != kNoRow; });
  ASSERT_EQ(rows.size(), grid.cells.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i], i);
  EXPECT_EQ(keys(grid).size(), grid.cells.size());
}

// The entry of a row is that of its box and axis.
TEST(CellGrid, EntriesBelongToTheirCells) {
  const CellGrid grid = build_grid(load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/occluded.glb"), 7);
  ASSERT_GT(grid.cells.size(), 100U);
  for (std::uint32_t row = 0; row < grid.cells.size(); ++row) {
    const GridCell& cell = grid.cells[row];
    const glm::vec3 place = (cell.centre - grid.frame.origin) * grid.frame.boxes_per_unit;
    const int k = cell.normal.x != 0 ? 0 : cell.normal.y != 0 ? 1 : 2;
    const auto normal = static_cast<std::uint32_t>(2 * k + (cell.normal[k] < 0 ? 1 : 0));
    EXPECT_EQ(grid.rows[grid.frame.entry(glm::uvec3(place), normal)], row);
  }
}

// Only the boxes along the diagonal, and their neighbours where it runs through the edges between them.
TEST(CellGrid, LeavesOutBoxesThatNoTriangleTouches) {
  Scene scene;
  add_quad(scene, {0, 0, 0}, {8, 8.3F, 0}, {0, 0, 8}, 0);
  const CellGrid grid = build_grid(scene, 8);
  EXPECT_LE(grid.cells.size(), 8U * (8 + 7) * 4);
  EXPECT_GE(grid.cells.size(), 8U * 8 * 2);
  for (const GridCell& cell : grid.cells) {
    EXPECT_LT(std::abs(cell.centre.y - cell.centre.x * 8.3F / 8), 1.5F);
    EXPECT_EQ(cell.normal.z, 0);
  }
}

// Normals to the left and to the right: halfway they are nearest to z, which no vertex and only the face is.
TEST(CellGrid, FollowsInterpolatedNormals) {
  const glm::vec3 left(-0.8F, 0, 0.6F);
  const glm::vec3 right(0.8F, 0, 0.6F);
  // The face's normal is y.
  const CellGrid grid = build_grid(one_triangle({{{0, 0, 0}, {0, 0, 9}, {9, 0, 0}}}, {left, left, right}), 9);
  const auto has = [&](glm::vec3 centre, glm::vec3 normal) {
    return std::ranges::any_of(grid.cells, [&](const GridCell& c) {
      return c.centre.x == centre.x && c.centre.z == centre.z && c.normal == normal;
    });
  };
  for (const float side : {-1.0F, 1.0F}) {
    EXPECT_TRUE(has({0.5F, 0.5F, 0.5F}, {side, 0, 0}));
    EXPECT_FALSE(has({0.5F, 0.5F, 0.5F}, {0, 0, side}));
    EXPECT_TRUE(has({4.5F, 0.5F, 0.5F}, {0, 0, side}));
    EXPECT_FALSE(has({4.5F, 0.5F, 0.5F}, {side, 0, 0}));
    EXPECT_TRUE(has({4.5F, 0.5F, 0.5F}, {0, side, 0})) << "of the face";
  }
}

}  // namespace
}  // namespace qtrace
