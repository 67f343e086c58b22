// Paths from the lights: closed forms, agreement with the camera's own paths whatever the table holds, the
// same bits. What one path brings to several pixels ties these together, so the noise of a block comes from
// the spread of seeds.
#include "engine/core/check.h"
#include "engine/scene/analytic.h"
#include "tests/render/comparison.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <boost/math/distributions/students_t.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kSide = 32;
constexpr int kBlockSide = 16;
constexpr int kBlocksOfImage = (kSide / kBlockSide) * (kSide / kBlockSide);
constexpr int kSeeds = 12;

RenderSettings light_path_settings(Nee nee, int max_bounces, LightPaths paths = LightPaths::trace) {
  RenderSettings settings = square_settings(kSide, max_bounces, nee);
  settings.light_paths = paths;
  settings.light_path_trial = 0;
  settings.russian_roulette_start = max_bounces;
  settings.rl.sites_per_object = 20;
  settings.rl.bins_theta = settings.rl.bins_phi = 6;
  settings.rl.trial_frames = 0;
  return settings;
}

Estimate block_of(const RadianceImage& image, int block) {
  const int row = kSide / kBlockSide;
  return block_estimate(image, block % row * kBlockSide, block / row * kBlockSide, kBlockSide);
}

using Change = std::function<void(Tracer&)>;

// Of each block, by the seeds.
std::vector<Estimate> blocks_over_seeds(const Scene& scene, RenderSettings settings, int frames,
                                        const Change& change = {}) {
  std::vector<double> sums(kBlocksOfImage, 0.0), squares(kBlocksOfImage, 0.0);
  for (int i = 0; i < kSeeds; ++i, ++settings.seed) {
    Tracer tracer(device(), scene, settings);
    if (change) change(tracer);
    const Rendering r = render(tracer, frames);
    EXPECT_EQ(r.non_finite, 0U);
    for (int block = 0; block < kBlocksOfImage; ++block) {
      const double mean = block_of(r.image, block).mean;
      sums[static_cast<std::size_t>(block)] += mean;
      squares[static_cast<std::size_t>(block)] += mean * mean;
    }
  }
  std::vector<Estimate> estimates;
  for (std::size_t block = 0; block < kBlocksOfImage; ++block) {
    const double mean = sums[block] / kSeeds;
    const double variance = std::max(0.0, squares[block] / kSeeds - mean * mean) / (kSeeds - 1);
    estimates.push_back({mean, variance});
  }
  return estimates;
}

double t_threshold(std::size_t comparisons) {
  return boost::math::quantile(boost::math::complement(
      boost::math::students_t(kSeeds - 1), kFalseAlarm / (2.0 * static_cast<double>(comparisons))));
}

void expect_blocks(const std::vector<Estimate>& found, const std::vector<Estimate>& truth,
                   std::size_t comparisons) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LT(z_score(found[i], truth[i]), t_threshold(comparisons * kBlocksOfImage))
        << "block " << i << ": " << found[i].mean << " +- " << std::sqrt(found[i].variance) << " against "
        << truth[i].mean << " +- " << std::sqrt(truth[i].variance);
  }
}

std::vector<Estimate> camera_blocks(const Scene& scene, RenderSettings settings, int frames) {
  settings.light_paths = LightPaths::none;
  settings.sampler = Sampler::bsdf;
  settings.nee = Nee::one_ray;
  settings.seed = 900;
  const Rendering r = render(scene, settings, frames);
  std::vector<Estimate> estimates;
  for (int block = 0; block < kBlocksOfImage; ++block) estimates.push_back(block_of(r.image, block));
  return estimates;
}

// A floor of 8 x 8 seen from above, which the camera sees nothing else of.
Scene floor_seen_from_above(bool is_flat) {
  Scene scene = lit_floor(0.6F, 12, 1, 2).scene;
  scene.camera = look_at({3, 1.5F, 3}, {1, 0, 1}, 0.7F);
  if (is_flat) scene.camera.film_height = 1.2F;
  return scene;
}

// The mean over each block of a closed form of the radiance at the points that the camera sees.
std::vector<Estimate> truth_of(const Scene& scene, RenderSettings settings,
                               const std::function<double(const glm::vec3&)>& radiance) {
  constexpr int kFiner = 8;
  settings.light_paths = LightPaths::none;
  settings.nee = Nee::one_ray;
  settings.width = settings.height = kFiner * kSide;
  const FirstHitImage hits = Tracer(device(), scene, settings).first_hit();
  std::vector<Estimate> truth(kBlocksOfImage);
  const int row = kSide / kBlockSide;
  const int side = kFiner * kBlockSide;
  for (int y = 0; y < settings.height; ++y) {
    for (int x = 0; x < settings.width; ++x) {
      const glm::vec3 p = hits.position[static_cast<std::size_t>(y * settings.width + x)];
      truth[static_cast<std::size_t>(y / side * row + x / side)].mean += radiance(p) / (1.0 * side * side);
    }
  }
  return truth;
}

TEST(LightPaths, AFloorUnderALampInClosedForm) {
  for (const bool is_flat : {false, true}) {
    const Scene scene = floor_seen_from_above(is_flat);
    for (const Nee nee : {Nee::none, Nee::one_ray}) {
      SCOPED_TRACE(testing::Message() << (is_flat ? "parallel rays, " : "a pinhole, ") << enum_name(nee));
      const RenderSettings settings = light_path_settings(nee, 1);
      const LitFloor floor = lit_floor(0.6F, 12, 1, 2);
      const auto truth =
          truth_of(scene, settings, [&](const glm::vec3& p) { return floor.radiance(p.x, p.z); });
      expect_blocks(blocks_over_seeds(scene, settings, 8), truth, 4);
    }
  }
}

// So many light paths that nearly all weight is theirs.
TEST(LightPaths, LightsWithoutASurfaceInClosedForm) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5F))};
  add_quad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 0);
  scene.camera = look_at({0, 4, 0.1F}, {0, 0, 0}, 0.8F);
  PunctualLight point, spot, sun;
  point.position = {0.5F, 1, 0.3F};
  point.intensity = glm::vec3(3);
  point.range = 2;
  spot.kind = PunctualLight::Kind::spot;
  spot.position = {-0.5F, 2, 0};
  spot.direction = {0, -1, 0};
  spot.intensity = glm::vec3(5);
  spot.inner_cone_angle = 0.1F;
  spot.outer_cone_angle = 0.6F;
  sun.kind = PunctualLight::Kind::directional;
  sun.direction = glm::normalize(glm::vec3(1, -1, 0.5F));
  sun.intensity = glm::vec3(2);
  const auto from = [](const PunctualLight& light, const glm::vec3& p) {
    const glm::dvec3 way = glm::dvec3(light.position) - glm::dvec3(p);
    const double d = glm::length(way);
    return double{light.intensity.x} * (way.y / d) / (d * d) *
           std::clamp(1 - std::pow(d / double{light.range}, 4), 0.0, 1.0);
  };
  const auto in_cone = [&](const glm::vec3& p) {
    const glm::dvec3 way = glm::normalize(glm::dvec3(p) - glm::dvec3(spot.position));
    const double inner = std::cos(double{spot.inner_cone_angle});
    const double outer = std::cos(double{spot.outer_cone_angle});
    const double part = std::clamp((-way.y - outer) / (inner - outer), 0.0, 1.0);
    return part * part;
  };
  RenderSettings settings = light_path_settings(Nee::one_ray, 1);
  settings.light_path_count = 1 << 15;
  const auto expect = [&](const PunctualLight& light,
                          const std::function<double(const glm::vec3&)>& irradiance) {
    scene.lights = {light};
    const auto truth =
        truth_of(scene, settings, [&](const glm::vec3& p) { return 0.5 * irradiance(p) / std::numbers::pi; });
    expect_blocks(blocks_over_seeds(scene, settings, 2), truth, 3);
  };
  expect(point, [&](const glm::vec3& p) { return from(point, p); });
  expect(spot, [&](const glm::vec3& p) { return from(spot, p) * in_cone(p); });
  expect(sun, [&](const glm::vec3&) { return -2.0 * double{sun.direction.y}; });
}

// Each number of events that a path may have, and none beyond the last.
TEST(LightPaths, AFurnaceOfLamps) {
  const Scene scene = furnace_box(0.7F, 2);
  for (const Nee nee : {Nee::none, Nee::one_ray}) {
    for (const Sampler sampler : {Sampler::bsdf, Sampler::rl}) {
      const bool is_traced = (nee == Nee::none) == (sampler == Sampler::bsdf);
      RenderSettings settings =
          light_path_settings(nee, 6, is_traced ? LightPaths::trace : LightPaths::connect);
      SCOPED_TRACE(testing::Message() << enum_name(sampler) << " + " << enum_name(nee) << ", "
                                      << enum_name(settings.light_paths));
      settings.sampler = sampler;
      const std::vector<Estimate> truth(kBlocksOfImage, {furnace_radiance(0.7, 2, 6), 0});
      expect_blocks(blocks_over_seeds(scene, settings, 4), truth, 4);
    }
  }
}

// Light paths pass mirrors, whose events are not kept and count all the same.
TEST(LightPaths, AFurnaceOfLampsHalfOfWhichAreMirrors) {
  Scene scene = furnace_box(1, 2);
  Material mirror = scene.materials.front();
  mirror.metallic = 1;
  mirror.roughness = 0;
  scene.materials.push_back(mirror);
  for (std::size_t i = 0; i < scene.triangles.size() / 2; ++i) scene.triangles[i].material = 1;
  const RenderSettings settings = light_path_settings(Nee::one_ray, 3, LightPaths::connect);
  const std::vector<Estimate> truth(kBlocksOfImage, {furnace_radiance(1, 2, 3), 0});
  expect_blocks(blocks_over_seeds(scene, settings, 16), truth, 1);
}

// A lamp shines at a wall, which lights a floor, all within a block that absorbs two thirds of the light on
// half a metre: the way from the lamp to the wall is known to be in there from the camera's side alone.
TEST(LightPaths, ConnectionsKnowWhatTheLampStandsIn) {
  Scene scene = furnace_box(0, 0, 0.9F);
  for (Triangle& t : scene.triangles) {  // turned inside out
    std::swap(t.position[1], t.position[2]);
    for (glm::vec3& n : t.normal) n = -n;
  }
  Material block;
  block.metallic = block.roughness = 0;
  block.transmission = block.ior = 1;
  block.is_thin = false;
  block.attenuation_color = glm::vec3(0.33F);
  block.attenuation_distance = 0.5F;
  scene.materials = {block, lambert(glm::vec3(0.8F)), lambert(glm::vec3(0), glm::vec3(20))};
  add_quad(scene, {-0.7F, -0.7F, -0.7F}, {0, 0, 1.4F}, {1.4F, 0, 0}, 1);   // floor
  add_quad(scene, {-0.7F, -0.7F, -0.75F}, {1.4F, 0, 0}, {0, 1.4F, 0}, 1);  // wall, towards +z
  add_quad(scene, {-0.2F, -0.1F, -0.1F}, {0, 0.4F, 0}, {0.4F, 0, 0}, 2);   // lamp, towards -z
  scene.camera = look_at({0, 1.2F, 1.6F}, {0, -0.7F, 0.1F}, 0.5F);
  const RenderSettings settings = light_path_settings(Nee::one_ray, 3, LightPaths::connect);
  expect_blocks(blocks_over_seeds(scene, settings, 16), camera_blocks(scene, settings, 1024), 1);
}

// A floor under a sky that is the same everywhere.
TEST(LightPaths, AConstantEnvironment) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.5F))};
  add_quad(scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 0);
  scene.camera = look_at({0, 2, 0.1F}, {0, 0, 0}, 0.5F);
  RenderSettings settings = light_path_settings(Nee::none, 1);
  settings.environment = {3, 3, 3};
  const std::vector<Estimate> truth(kBlocksOfImage, {1.5, 0});
  expect_blocks(blocks_over_seeds(scene, settings, 8), truth, 1);
}

TEST(LightPaths, FrozenTablesChangeTheVarianceAlone) {
  const Scene scene = glossy_room();
  RenderSettings settings = light_path_settings(Nee::one_ray, 3, LightPaths::connect);
  settings.environment = {0.3, 0.2, 0.1};
  const std::vector<Estimate> truth = camera_blocks(scene, settings, 256);
  settings.sampler = Sampler::rl;
  for (const bool is_random : {false, true}) {
    SCOPED_TRACE(is_random ? "random" : "zero");
    expect_blocks(blocks_over_seeds(scene, settings, 8,
                                    [&](Tracer& tracer) {
                                      tracer.set_learning(false);
                                      std::vector<float> values(tracer.table()->values().size(), 0.0F);
                                      std::mt19937 random(7);
                                      std::uniform_real_distribution<float> uniform;
                                      for (float& value : values)
                                        value = is_random ? std::pow(10.0F, 4 * uniform(random) - 2) : 0;
                                      tracer.table()->set_values(values);
                                    }),
                  truth, 2);
  }
}

// While it learns, with Sobol' points, learned lights, roulette, and another number of paths than of pixels.
TEST(LightPaths, EverythingAtOnce) {
  const Scene scene = glossy_room();
  RenderSettings settings = light_path_settings(Nee::one_ray, 5);
  const std::vector<Estimate> truth = camera_blocks(scene, settings, 256);
  settings.sampler = Sampler::rl;
  settings.random = RandomNumbers::sobol;
  settings.lights = LightChoice::learned;
  settings.russian_roulette_start = 1;
  for (const LightPaths paths : {LightPaths::trace, LightPaths::connect}) {
    settings.light_paths = paths;
    settings.light_path_count = paths == LightPaths::trace ? 3000 : 500;
    expect_blocks(blocks_over_seeds(scene, settings, 8), truth, 2);
  }
}

TEST(LightPaths, TheSameSeedGivesTheSameBits) {
  const Scene scene = glossy_room();
  RenderSettings settings = light_path_settings(Nee::one_ray, 4, LightPaths::connect);
  settings.sampler = Sampler::rl;
  EXPECT_EQ(render(scene, settings, 6).image.mean, render(scene, settings, 6).image.mean);
}

TEST(LightPaths, AreCounted) {
  const Scene scene = shipped("cornell_box.glb");
  RenderSettings settings = light_path_settings(Nee::one_ray, 4, LightPaths::connect);
  settings.light_path_count = 777;
  Tracer tracer(device(), scene, settings);
  render(tracer, 2);
  const FrameCounters counters = tracer.last_frame_counters();
  EXPECT_GT(counters.splats, 100U);
  EXPECT_LT(counters.splats, 4U * 777U);
  EXPECT_GT(counters.light_rays, counters.splats + 777U);
  EXPECT_GT(counters.connections, static_cast<std::uint64_t>(kSide * kSide / 2));
  EXPECT_LT(counters.connections, static_cast<std::uint64_t>(3 * kSide * kSide));
  EXPECT_GT(counters.rays, counters.light_rays + counters.connections);
  settings.light_paths = LightPaths::none;
  Tracer without(device(), scene, settings);
  render(without, 2);
  EXPECT_EQ(without.last_frame_counters().light_rays, 0U);
  EXPECT_EQ(without.last_frame_counters().splats, 0U);
  EXPECT_EQ(without.last_frame_counters().connections, 0U);
}

void expect_refused(const Scene& scene, const RenderSettings& settings, const std::string& reason) {
  try {
    render(scene, settings, 1);
    FAIL() << "rendered";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(LightPaths, AreRefusedWhereTheirWeightsWouldBeWrong) {
  const Scene scene = shipped("cornell_box.glb");
  RenderSettings settings = light_path_settings(Nee::two_ray, 4);
  expect_refused(scene, settings, "set nee to one_ray");
  settings.nee = Nee::one_ray;
  settings.sampler = Sampler::rl;
  settings.rl.guided_bounces = 3;
  expect_refused(scene, settings, "raise it to 4 or more");
}

}  // namespace
}  // namespace qtrace::test
