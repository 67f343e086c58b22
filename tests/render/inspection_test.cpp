// Inspection against closed forms: which cell a pixel shows, and what arrives there from all directions.
#include "engine/tracer/inspection.h"

#include "engine/scene/analytic.h"
#include "tests/support/render.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace qtrace::test {
namespace {

constexpr int kSize = 64;  // of hemispheres

RenderSettings small_settings(int max_bounces = 3) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.rl = goswami_table();
  settings.width = settings.height = 24;
  settings.max_bounces = settings.russian_roulette_start = max_bounces;
  settings.rl.sites_per_object = 20;
  settings.rl.bins_theta = settings.rl.bins_phi = 4;
  return settings;
}

// Of a pixel's centre: from the middle of the unit disk, squared.
double disk_radius2(int index) {
  const double x = (index % kSize + 0.5) * 2 / kSize - 1;
  const double y = (index / kSize + 0.5) * 2 / kSize - 1;
  return x * x + y * y;
}

double mean(const glm::dvec3& v) { return (v.r + v.g + v.b) / 3; }

// Squared distance from a first hit to the nearest cell that serves it, or to the one given.
double distance2(const FirstHitImage& hits, std::size_t pixel, const CellState& cell) {
  const glm::dvec3 d = glm::dvec3(cell.position) - glm::dvec3(hits.position[pixel]);
  const bool serves = glm::dot(cell.normal, hits.normal[pixel]) > 0.9F;
  return serves ? glm::dot(d, d) : std::numeric_limits<double>::infinity();
}

TEST(InspectionCells, PixelsShowTheNearestCellOnTheirSide) {
  const Scene scene = furnace_box(0.5F, 1);
  const RenderSettings settings = small_settings();
  const FirstHitImage hits = Tracer(device(), scene, settings).first_hit();
  const Inspection inspection(device(), scene, settings);
  const std::vector<int> cells = inspection.pixel_cells();
  ASSERT_EQ(cells.size(), hits.position.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASSERT_GE(cells[i], 0) << i;
    double nearest = std::numeric_limits<double>::infinity();
    for (const CellState& cell : inspection.cells()) nearest = std::min(nearest, distance2(hits, i, cell));
    const CellState& found = inspection.cells()[static_cast<std::size_t>(cells[i])];
    EXPECT_LE(distance2(hits, i, found), nearest * (1 + 1e-4)) << i;
  }
}

TEST(InspectionCells, PixelsOfTheBackgroundHaveNone) {
  Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
  scene.camera = look_at({0, 0.5F, 0}, {1, 0.5F, 0}, 1);
  const std::vector<int> cells = Inspection(device(), scene, small_settings()).pixel_cells();
  EXPECT_EQ(cells[24 * 6 + 12], -1);  // the sky, below the light's edge
  EXPECT_GE(cells[24 * 23 + 12], 0);  // the floor
}

TEST(InspectionHemisphere, AFurnaceIsEvenlyBright) {
  constexpr int kBounces = 4;
  constexpr int kSamples = 16;
  const Inspection inspection(device(), furnace_box(0.6F, 1.5F), small_settings(kBounces));
  const Hemisphere hemisphere = inspection.hemisphere({12, 12}, kSize, kSamples);
  const double truth = furnace_radiance(0.6, 1.5, kBounces);
  double sum = 0;
  int inside = 0;
  for (std::size_t i = 0; i < hemisphere.bin.size(); ++i) {
    EXPECT_EQ(hemisphere.bin[i] >= 0, disk_radius2(static_cast<int>(i)) < 1) << i;
    if (hemisphere.bin[i] < 0) continue;
    sum += mean(hemisphere.radiance[i]);
    ++inside;
  }
  EXPECT_NEAR(sum / inside / truth, 1, 0.005);
  ASSERT_EQ(hemisphere.bin_radiance.size(), 16U);
  for (const double radiance : hemisphere.bin_radiance) EXPECT_NEAR(radiance / truth, 1, 0.03);
}

// The truth owes nothing to how the run learned.
TEST(InspectionHemisphere, TheRunsMethodChangesNothing) {
  const Scene scene = furnace_box(0.6F, 1.5F);
  const RenderSettings one = small_settings();
  RenderSettings other = one;
  other.nee = Nee::two_ray;
  other.lights = LightChoice::learned;
  other.rl.update = UpdateRule::monte_carlo;
  const auto a = Inspection(device(), scene, one).hemisphere({3, 20}, kSize, 2);
  const auto b = Inspection(device(), scene, other).hemisphere({3, 20}, kSize, 2);
  EXPECT_EQ(a.radiance, b.radiance);
  EXPECT_EQ(a.bin, b.bin);
}

TEST(InspectionHemisphere, BinsHaveEqualAreasAndTheirMeanCosines) {
  for (const BinMap map : {BinMap::cylindrical, BinMap::concentric}) {
    RenderSettings settings = small_settings(0);
    settings.rl.bin_map = map;
    const Hemisphere h = Inspection(device(), furnace_box(0.5F, 1), settings).hemisphere({12, 12}, kSize, 1);
    std::vector<double> pixels(16), cosines(16);
    for (std::size_t i = 0; i < h.bin.size(); ++i) {
      if (h.bin[i] < 0) continue;
      const auto bin = static_cast<std::size_t>(h.bin[i]);
      pixels[bin] += 1;
      cosines[bin] += 1 - disk_radius2(static_cast<int>(i));
    }
    const double wanted = std::numbers::pi / 4 * kSize * kSize / 16;
    for (std::size_t b = 0; b < 16; ++b) {
      EXPECT_NEAR(pixels[b] / wanted, 1, 0.06) << b;
      EXPECT_NEAR(cosines[b] / pixels[b], h.bin_cosine[b], 0.01) << b;
    }
  }
}

// Over the middle of the floor stands a square light, and nothing else sends light there.
TEST(InspectionHemisphere, AboveALitFloorStandsTheLight) {
  constexpr float kEmission = 10;
  const LitFloor lit = lit_floor(0.8F, kEmission, 1, 1);
  const Hemisphere h = Inspection(device(), lit.scene, small_settings()).hemisphere({12, 12}, kSize, 16);
  double irradiance = 0;
  const double pixel_angle = 8.0 / (kSize * kSize);  // the disk of area pi holds 2 pi sr
  for (int i = 0; i < kSize * kSize; ++i) {
    const double radiance = mean(h.radiance[static_cast<std::size_t>(i)]);
    EXPECT_LE(radiance, kEmission * (1 + 1e-5));
    irradiance += radiance * (1 - disk_radius2(i)) * pixel_angle;
    // The light's edges stand at radii squared of 0.106 (in their middles) to 0.184 (at the corners).
    const bool inside = disk_radius2(i) < 0.08;
    const bool outside = disk_radius2(i) > 0.25;
    if (inside || outside) {
      EXPECT_NEAR(radiance, inside ? kEmission : 0, 1e-4) << i;
    }
  }
  EXPECT_NEAR(irradiance / (lit.radiance(0, 0) * std::numbers::pi / 0.8), 1, 0.01);
}

// To one side of the light: what a table learns there stands in the same bins as what is true there.
TEST(InspectionHemisphere, TruthAndTableShareTheirBins) {
  Scene scene = lit_floor(0.8F, 10, 4, 4).scene;
  scene.camera = look_at({4, 2, 2.5F}, {4, 0, 2}, 0.05F);
  RenderSettings settings = small_settings(1);
  settings.rl.sites_per_object = 400;
  settings.rl.bins_theta = settings.rl.bins_phi = 8;
  Tracer tracer(device(), scene, settings);
  render(tracer, 64);
  const std::vector<float> values = tracer.table()->values();
  const Inspection inspection(device(), scene, settings);
  const auto cell = static_cast<std::size_t>(inspection.pixel_cells()[24 * 12 + 12]);
  const std::vector<double> truth = inspection.hemisphere({12, 12}, kSize, 8).bin_radiance;
  double inside = 0;
  double outside = 0;
  for (std::size_t bin = 0; bin < 64; ++bin) {
    const double learned = static_cast<double>(values[64 * cell + bin]);
    (truth[bin] > 0 ? inside : outside) += learned;
  }
  EXPECT_GT(inside, 20 * outside);
}

}  // namespace
}  // namespace qtrace::test
