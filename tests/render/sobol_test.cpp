// Renders with Sobol' points: the same image as with independent numbers, with less error, and the same bits
// however they come about. Their noise is known from replicates alone.
#include "engine/scene/analytic.h"
#include "tests/render/comparison.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace qtrace::test {
namespace {

RenderSettings with_sobol(RenderSettings settings, int replicates) {
  settings.random = RandomNumbers::sobol;
  settings.replicates = replicates;
  return settings;
}

double mean_variance(const RadianceImage& image) {
  double sum = 0;
  for (const glm::dvec3& v : image.variance) sum += (v.r + v.g + v.b) / 3;
  return sum / static_cast<double>(image.pixels());
}

// Every sampler with every kind of next event estimation.
TEST(Sobol, AllMethodsEstimateTheImageOfIndependentNumbers) {
  const Scene scene = glossy_room();
  const auto settings = [](std::uint32_t seed, const Method& method) {
    RenderSettings s = with_method(base_settings(seed), method);
    s.environment = {0.3, 0.2, 0.1};
    return s;
  };
  const Rendering truth = render(scene, settings(900, {"", Sampler::bsdf, Nee::one_ray, {}}), 96);
  std::uint32_t seed = 1;
  for (const Method& method : all_methods()) {
    SCOPED_TRACE(method.name);
    RenderSettings s = with_sobol(settings(seed++, method), 8);
    s.stratified_events = method.nee == Nee::two_ray ? 2 : 1;
    expect_same_image(render(scene, s, 48), truth, all_methods().size() * kBlocks);
  }
}

// The variance between 16 replicates of n points, at n = 1 and at 16: with independent numbers a sixteenth.
TEST(Sobol, PointsTakeErrorAwayFasterThanSamplesDo) {
  const Scene scene = shipped("cornell_box.glb");
  RenderSettings settings = with_method(base_settings(3), {"", Sampler::bsdf, Nee::one_ray, {}});
  settings.max_bounces = 1;
  Tracer sobol(device(), scene, with_sobol(settings, 16));
  const double at_1 = mean_variance(render(sobol, 16).image);
  const double at_16 = mean_variance(render(sobol, 15 * 16).image);
  EXPECT_LT(std::log(at_16 / at_1) / std::log(16.0), -1.5);
  Tracer independent(device(), scene, settings);
  EXPECT_GT(mean_variance(render(independent, 256).image), 8 * at_16);
}

// Replicates are unbiased, and their spread is the variance that other seeds show: over pixels, the squared
// difference of two images has the mean of both variances.
TEST(Sobol, ReplicatesKnowTheirVariance) {
  const Scene scene = shipped("cornell_box.glb");
  const RenderSettings settings =
      with_sobol(with_method(base_settings(3), {"", Sampler::bsdf, Nee::one_ray, {}}), 8);
  RenderSettings other = settings;
  ++other.seed;
  const RadianceImage a = render(scene, settings, 64).image;
  const RadianceImage b = render(scene, other, 64).image;
  double squares = 0;
  double squares_of_squares = 0;
  for (std::size_t i = 0; i < a.pixels(); ++i) {
    const double difference = a.mean[i].g - b.mean[i].g;
    const double ratio = difference * difference / std::max(a.variance[i].g + b.variance[i].g, 1e-12);
    // Of t-distributed ratios with 7 + 7 degrees of freedom, the mean of the square is 14 / 12.
    squares += ratio;
    squares_of_squares += ratio * ratio;
  }
  const auto n = static_cast<double>(a.pixels());
  const double error = std::sqrt((squares_of_squares / n - squares * squares / n / n) / n);
  EXPECT_NEAR(squares / n, 14.0 / 12, z_threshold(1) * error + 0.1);
}

// A wall of 16 x 16 tiles, one for each pixel, lit from one side: each is an object with one cell, which one
// pixel alone teaches.
constexpr int kTiles = 16;

Scene wall_of_tiles() {
  Scene scene;
  scene.name = "tiles";
  scene.materials = {lambert(glm::vec3(1)), lambert(glm::vec3(0), glm::vec3(1))};
  const float size = 2.0F / kTiles;
  for (int y = 0; y < kTiles; ++y) {
    for (int x = 0; x < kTiles; ++x) {
      const glm::vec3 corner(static_cast<float>(x) * size - 1, static_cast<float>(y) * size - 1, -1);
      add_quad(scene, corner, {size, 0, 0}, {0, size, 0}, 0);
    }
  }
  add_quad(scene, {0, -100, 2}, {0, 200, 0}, {100, 0, 0}, 1);
  scene.camera = look_at({0, 0, 0}, {0, 0, -1}, 2 * std::atan(1.0F));
  return scene;
}

RenderSettings of_tiles(Sampler sampler) {
  RenderSettings settings;
  settings.width = settings.height = kTiles;
  settings.max_bounces = 1;
  settings.sampler = sampler;
  settings.rl.sites_per_object = 1;
  settings.rl.bins_theta = 1;
  settings.rl.bins_phi = 8;
  settings.rl.bin_floor = 0.2;
  settings.rl.bsdf_fraction = 0;
  settings.rl.mixture = Mixture::fixed;
  settings.rl.shrinkage = 0;
  settings.rl.trial_frames = 0;
  return settings;
}

double mean_of(const RadianceImage& image) {
  double sum = 0;
  for (const glm::dvec3& pixel : image.mean) sum += pixel.g;
  return sum / static_cast<double>(image.pixels());
}

// Given its earlier points, a pixel's next one is not uniform. Had those taught the table that it is drawn
// with, the mean would be off: seen here where a cell has one pixel, and hidden where it has many.
TEST(Sobol, TablesTaughtByOnePixelKeepTheMean) {
  const Scene scene = wall_of_tiles();
  RenderSettings settings = of_tiles(Sampler::bsdf);
  settings.random = RandomNumbers::sobol;
  const double truth = mean_of(render(scene, settings, 4096).image);  // to 1e-4 and less
  constexpr std::uint32_t kSeeds = 64;
  double sum = 0;
  double squares = 0;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    settings = of_tiles(Sampler::rl);
    settings.random = RandomNumbers::sobol;
    settings.seed = seed;
    const double mean = mean_of(render(scene, settings, 8).image);
    sum += mean;
    squares += mean * mean;
  }
  const double mean = sum / kSeeds;
  const double error = std::sqrt((squares / kSeeds - mean * mean) / (kSeeds - 1));
  EXPECT_LT(std::abs(mean - truth), z_threshold(1) * error) << mean << " +- " << error << " for " << truth;
  EXPECT_LT(error, 0.01) << "too noisy to see the bias";
}

// Whether frames are rendered at one go or a state is restored between them, with a table and with its trial.
TEST(Sobol, GoesOnWithTheSameBits) {
  const Scene scene = glossy_room();
  for (const Sampler sampler : {Sampler::bsdf, Sampler::rl}) {
    for (const int replicates : {1, 4}) {
      RenderSettings settings = with_sobol(base_settings(5), replicates);
      settings.width = settings.height = 24;
      settings.sampler = sampler;
      settings.nee = Nee::one_ray;
      settings.rl.sites_per_object = 8;
      Tracer whole(device(), scene, settings);
      render(whole, 7);
      const TracerState state = whole.state();
      render(whole, 14);
      Tracer later(device(), scene, settings);
      render(later, 2);  // forgotten
      later.restore(state);
      render(later, 14);
      EXPECT_EQ(later.radiance().mean, whole.radiance().mean);
      EXPECT_EQ(later.radiance().variance, whole.radiance().variance);
    }
  }
}

// With one frame nothing is stratified, but all else is as it will be.
TEST(Sobol, DiffersFromIndependentNumbersAndBetweenSeeds) {
  const Scene scene = glossy_room();
  RenderSettings settings = with_method(base_settings(3), {"", Sampler::bsdf, Nee::one_ray, {}});
  const auto independent = render(scene, settings, 2).image.mean;
  settings.random = RandomNumbers::sobol;
  const auto sobol = render(scene, settings, 2).image.mean;
  EXPECT_NE(sobol, independent);
  ++settings.seed;
  EXPECT_NE(render(scene, settings, 2).image.mean, sobol);
}

}  // namespace
}  // namespace qtrace::test
