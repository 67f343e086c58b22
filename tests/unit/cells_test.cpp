#include "engine/cells/hammersley.h"
#include "engine/cells/sites.h"
#include "engine/gltf/load_gltf.h"
#include "engine/scene/analytic.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <set>

namespace qtrace {
namespace {

TEST(Hammersley, IsTheKnownSet) {
  EXPECT_EQ(hammersley(0, 4), glm::dvec2(0.125, 0));
  EXPECT_EQ(hammersley(1, 4), glm::dvec2(0.375, 0.5));
  EXPECT_EQ(hammersley(2, 4), glm::dvec2(0.625, 0.25));
  EXPECT_EQ(hammersley(3, 4), glm::dvec2(0.875, 0.75));
}

RlSettings sites_each(SitePlacement placement, int count) {
  RlSettings settings = test::goswami_table();
  settings.site_placement = placement;
  settings.sites_per_object = count;
  return settings;
}

Scene unit_quad() {
  Scene scene;
  scene.materials = {lambert(glm::vec3(1))};
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 3, 0}, 0);
  return scene;
}

// The quad's UV map is the unit square, so site i stands at Hammersley point i, scaled.
TEST(Sites, StandAtHammersleyPointsThroughTheUvMap) {
  const CellSites cells = place_sites(unit_quad(), sites_each(SitePlacement::uv, 64));
  ASSERT_EQ(cells.sites.size(), 64U);
  for (std::uint32_t i = 0; i < 64; ++i) {
    const glm::dvec2 p = hammersley(i, 64);
    EXPECT_NEAR(cells.sites[i].position.x, 2 * p.x, 1e-5);
    EXPECT_NEAR(cells.sites[i].position.y, 3 * p.y, 1e-5);
    EXPECT_EQ(cells.sites[i].normal, glm::vec3(0, 0, 1));
  }
}

bool lies_on(const Triangle& t, glm::vec3 p) {
  const glm::dvec3 a = t.position[0];
  const glm::dvec3 e1 = glm::dvec3(t.position[1]) - a;
  const glm::dvec3 e2 = glm::dvec3(t.position[2]) - a;
  const glm::dvec3 n = glm::cross(e1, e2);
  const glm::dvec3 d = glm::dvec3(p) - a;
  const double u = glm::dot(glm::cross(d, e2), n) / glm::dot(n, n);
  const double v = glm::dot(glm::cross(e1, d), n) / glm::dot(n, n);
  constexpr double kSlack = 1e-3;
  return std::abs(glm::dot(d, n)) / glm::length(n) < 1e-4 && u > -kSlack && v > -kSlack && u + v < 1 + kSlack;
}

// On the shipped scene: as many living sites as asked for on every object, each on its object's surface.
class SitesOnSimple : public testing::TestWithParam<SitePlacement> {};

TEST_P(SitesOnSimple, AllLiveOnTheirObjects) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/simple.glb");
  const CellSites cells = place_sites(scene, sites_each(GetParam(), 100));
  EXPECT_TRUE(cells.warnings.empty());
  ASSERT_EQ(cells.first.size(), scene.objects.size() + 1);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    ASSERT_EQ(cells.first[o + 1] - cells.first[o], 100U);
    const Object& object = scene.objects[o];
    for (std::uint32_t s = cells.first[o]; s < cells.first[o + 1]; ++s) {
      EXPECT_NEAR(glm::length(cells.sites[s].normal), 1, 1e-5);
      const auto begin = scene.triangles.begin() + object.first_triangle;
      EXPECT_TRUE(std::any_of(begin, begin + object.triangle_count,
                              [&](const Triangle& t) { return lies_on(t, cells.sites[s].position); }))
          << object.name << ", site " << s;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Placements, SitesOnSimple, testing::Values(SitePlacement::uv, SitePlacement::area));

TEST(Sites, ByAreaFollowTheArea) {
  Scene scene = unit_quad();
  // One object of two quads, one nine times the other.
  add_quad(scene, {10, 0, 0}, {6, 0, 0}, {0, 9, 0}, 0);
  scene.objects[0].triangle_count = 4;
  scene.objects.pop_back();
  const CellSites cells = place_sites(scene, sites_each(SitePlacement::area, 1000));
  const auto on_large =
      std::ranges::count_if(cells.sites, [](const CellSite& s) { return s.position.x > 5; });
  EXPECT_NEAR(static_cast<double>(on_large), 900, 5);
}

TEST(Sites, OverlappingIslandsShareThePoints) {
  Scene scene = unit_quad();
  add_quad(scene, {0, 0, 10}, {2, 0, 0}, {0, 3, 0}, 0);
  scene.objects[0].triangle_count = 4;
  scene.objects.pop_back();
  const CellSites cells = place_sites(scene, sites_each(SitePlacement::uv, 100));
  const auto on_second =
      std::ranges::count_if(cells.sites, [](const CellSite& s) { return s.position.z > 5; });
  EXPECT_NEAR(static_cast<double>(on_second), 50, 2);
}

TEST(Sites, RepeatingCoordinatesAreWrapped) {
  Scene scene = unit_quad();
  for (Triangle& t : scene.triangles) {
    for (glm::vec2& uv : t.uv) uv = uv * 3.0F - glm::vec2(7, 1);
  }
  const CellSites cells = place_sites(scene, sites_each(SitePlacement::uv, 90));
  EXPECT_EQ(cells.sites.size(), 90U);
  // Nine tiles lie over one another: the sites spread over all of them.
  std::set<std::pair<int, int>> tiles;
  for (const CellSite& s : cells.sites) tiles.insert({int(s.position.x / 2 * 3), int(s.position.y / 3 * 3)});
  EXPECT_GE(tiles.size(), 8U);
}

TEST(Sites, WithoutUvMapArePlacedByAreaWithAWarning) {
  Scene scene = unit_quad();
  scene.objects[0].has_uv = false;
  const CellSites cells = place_sites(scene, sites_each(SitePlacement::uv, 10));
  EXPECT_EQ(cells.sites.size(), 10U);
  ASSERT_EQ(cells.warnings.size(), 1U);
  EXPECT_NE(cells.warnings[0].find("no UV map"), std::string::npos);
}

TEST(Sites, WithADegenerateUvMapArePlacedByAreaWithAWarning) {
  Scene scene = unit_quad();
  for (Triangle& t : scene.triangles) t.uv = {};
  const CellSites cells = place_sites(scene, sites_each(SitePlacement::uv, 10));
  EXPECT_EQ(cells.sites.size(), 10U);
  ASSERT_EQ(cells.warnings.size(), 1U);
  EXPECT_NE(cells.warnings[0].find("covers nearly nothing"), std::string::npos);
}

}  // namespace
}  // namespace qtrace
