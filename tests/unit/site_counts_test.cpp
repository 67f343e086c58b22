#include "engine/cells/site_counts.h"
#include "engine/cells/sites.h"
#include "engine/gltf/load_gltf.h"
#include "engine/scene/analytic.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace qtrace {
namespace {

// An object of every area, beside one another.
Scene quads(const std::vector<float>& areas) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(1))};
  float x = 0;
  for (const float area : areas) {
    add_quad(scene, {x, 0, 0}, {std::sqrt(area), 0, 0}, {0, std::sqrt(area), 0}, 0);
    x += 2 * std::sqrt(area);
  }
  return scene;
}

RlSettings total(int sites) {
  RlSettings settings = test::goswami_table();
  settings.sites_per_object = 0;
  settings.total_sites = sites;
  return settings;
}

using Counts = std::vector<std::uint32_t>;

TEST(SiteCounts, AreTheSameOnEveryObjectWithoutATotal) {
  EXPECT_EQ(site_counts(quads({1, 9}), test::goswami_table()), (Counts{100, 100}));
}

TEST(SiteCounts, FollowTheArea) {
  EXPECT_EQ(site_counts(quads({1, 9, 90}), total(1000)), (Counts{10, 90, 900}));
}

// Shares of 3.2, 3.41 and 3.39 make nine; the tenth goes to the largest remainder, of equal ones to the
// first.
TEST(SiteCounts, GiveWhatIsLeftToTheLargestRemainder) {
  EXPECT_EQ(site_counts(quads({3.2F, 3.41F, 3.39F}), total(10)), (Counts{3, 4, 3}));
  EXPECT_EQ(site_counts(quads({1, 1}), total(7)), (Counts{4, 3}));
}

TEST(SiteCounts, GiveEveryObjectASite) {
  EXPECT_EQ(site_counts(quads({1, 1e-6F, 1e-6F, 1}), total(10)), (Counts{4, 1, 1, 4}));
  // 1.05 of 21 falls below one once others took theirs.
  EXPECT_EQ(site_counts(quads({19.5F, 1.05F, 0.2F, 0.25F}), total(21)), (Counts{18, 1, 1, 1}));
  EXPECT_EQ(site_counts(quads({5, 1, 1}), total(2)), (Counts{1, 1, 1})) << "more objects than sites";
}

TEST(SiteCounts, LeaveOutObjectsWithoutTriangles) {
  Scene scene = quads({1, 1});
  scene.objects.push_back({"empty", static_cast<std::uint32_t>(scene.triangles.size()), 0, false});
  EXPECT_EQ(site_counts(scene, total(7)), (Counts{4, 3, 0}));
  EXPECT_EQ(site_counts(scene, test::goswami_table()), (Counts{100, 100, 0}));
}

TEST(SiteCounts, SumToTheTotalOnTheShippedScenes) {
  for (const char* name : {"simple", "occluded", "cornell_box"}) {
    const Scene scene = load_gltf(std::string(QTRACE_SOURCE_DIR "/configs/scenes/") + name + ".glb");
    for (const int sites : {20, 101, 1000, 54321}) {
      const Counts counts = site_counts(scene, total(sites));
      EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), sites) << name;
      EXPECT_GE(std::ranges::min(counts), 1U);
    }
  }
}

double mean_spacing(std::span<const CellSite> sites) {
  double sum = 0;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < sites.size(); ++j) {
      if (i != j) nearest = std::min(nearest, double{glm::distance(sites[i].position, sites[j].position)});
    }
    sum += nearest;
  }
  return sum / static_cast<double>(sites.size());
}

// Objects a hundred times as large as others have their sites as far apart as they.
TEST(SiteCounts, SpaceSitesEquallyOverTheScene) {
  const Scene scene = quads({1, 16, 100});
  for (const SitePlacement placement : {SitePlacement::uv, SitePlacement::area}) {
    RlSettings settings = total(117 * 16);
    settings.site_placement = placement;
    const CellSites cells = place_sites(scene, settings);
    ASSERT_EQ(cells.sites.size(), 117U * 16);
    std::vector<double> spacings;
    for (std::size_t o = 0; o < 3; ++o) {
      const std::size_t count = cells.first[o + 1] - cells.first[o];
      spacings.push_back(mean_spacing(std::span(cells.sites).subspan(cells.first[o], count)));
    }
    // A Hammersley set's least distance wavers with its size.
    EXPECT_LT(std::ranges::max(spacings) / std::ranges::min(spacings), 1.5) << enum_name(placement);
  }
}

}  // namespace
}  // namespace qtrace
