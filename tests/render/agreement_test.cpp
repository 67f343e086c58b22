// All methods estimate the same image, whatever their table holds.
#include "tests/render/comparison.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <random>

namespace qtrace::test {
namespace {

void expect_all_methods_agree(const Scene& scene, int frames, std::array<double, 3> environment = {0, 0, 0}) {
  const auto settings = [&](std::uint32_t seed, const Method& method) {
    RenderSettings s = with_method(base_settings(seed), method);
    s.environment = environment;
    return s;
  };
  const Rendering truth = render(scene, settings(900, {"", Sampler::bsdf, Nee::one_ray, {}}), 2 * frames);
  std::uint32_t seed = 1;
  for (const Method& method : all_methods()) {
    SCOPED_TRACE(method.name);
    const Rendering r = render(scene, settings(seed++, method), frames);
    expect_same_image(r, truth, all_methods().size() * kBlocks);
  }
}

TEST(Agreement, AllMethodsOnOccluded) { expect_all_methods_agree(shipped("occluded.glb"), 96); }

TEST(Agreement, AllMethodsOnGlossyMaterials) { expect_all_methods_agree(glossy_room(), 96, {0.3, 0.2, 0.1}); }

// Without the BSDF's share, all directions come from what was learned, as in Goswami 2020.
TEST(Agreement, TableAloneWhileItLearns) {
  const Scene scene = shipped("cornell_box.glb");
  RenderSettings settings = with_method(base_settings(950), {"", Sampler::bsdf, Nee::one_ray, {}});
  settings.max_bounces = 2;
  const Rendering truth = render(scene, settings, 256);
  settings.rl.bsdf_fraction = 0;
  settings.rl.bin_floor = 0.3;
  for (const UpdateRule update : {UpdateRule::expected_sarsa, UpdateRule::q_learning}) {
    for (const InitialTable initial : {InitialTable::zero, InitialTable::random}) {
      SCOPED_TRACE(testing::Message() << enum_name(update) << " from " << enum_name(initial));
      settings.rl.initial_table = initial;
      ++settings.seed;
      const Rendering r = render(scene, with_method(settings, {"", Sampler::rl, Nee::none, update}), 256);
      expect_same_image(r, truth, 4 * kLargeBlocks, kLargeBlock);
    }
  }
}

// Turned so that no wall is square to an axis.
Scene turned(Scene scene) {
  const glm::mat4 turn = glm::rotate(glm::mat4(1), 0.7F, glm::normalize(glm::vec3(1, 2, -0.6F)));
  for (Triangle& t : scene.triangles) {
    for (glm::vec3& p : t.position) p = glm::vec3(turn * glm::vec4(p, 1));
    for (glm::vec3& n : t.normal) n = glm::vec3(turn * glm::vec4(n, 0));
  }
  scene.camera.world_from_camera = turn * scene.camera.world_from_camera;
  return scene;
}

// States that are no Voronoi cells, and directions from the table alone, in frames that lie askew to the
// walls. Coarse boxes share their rows among surfaces that see different light.
TEST(Agreement, GridCells) {
  const Scene scene = turned(shipped("cornell_box.glb"));
  RenderSettings settings = with_method(base_settings(960), {"", Sampler::bsdf, Nee::one_ray, {}});
  settings.max_bounces = 2;
  const Rendering truth = render(scene, settings, 128);
  settings.rl.cells = CellKind::grid;
  settings.rl.bsdf_fraction = 0;
  settings.rl.bin_floor = 0.3;
  for (const int resolution : {3, 16}) {
    SCOPED_TRACE(testing::Message() << "resolution " << resolution);
    settings.rl.grid_resolution = resolution;
    ++settings.seed;
    const Rendering r = render(scene, with_method(settings, {"", Sampler::rl, Nee::one_ray, {}}), 128);
    expect_same_image(r, truth, 2 * kBlocks);
  }
}

TEST(Agreement, RussianRouletteKeepsTheMean) {
  const Scene scene = shipped("cornell_box.glb");
  RenderSettings settings = with_method(base_settings(3), {"", Sampler::bsdf, Nee::one_ray, {}});
  settings.max_bounces = 8;
  settings.russian_roulette_start = 0;
  const Rendering with = render(scene, settings, 128);
  settings.seed = 4;
  settings.russian_roulette_start = 8;
  expect_same_image(with, render(scene, settings, 128), kBlocks);
}

std::vector<float> mutated_table(std::size_t entries, int kind) {
  std::vector<float> values(entries, 0.0F);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform;
  if (kind == 1) {
    for (std::size_t i = 0; i < entries; i += 36) values[i + 7] = 1e8F;
  }
  if (kind == 2) {
    for (float& value : values) value = std::pow(10.0F, 6 * uniform(random) - 3);
  }
  return values;
}

// A frozen table of zeros, of one huge bin per cell, of random values over six decades.
TEST(Agreement, MutatedTablesChangeTheVarianceAlone) {
  const Scene scene = shipped("cornell_box.glb");
  for (const Nee nee : {Nee::none, Nee::one_ray}) {
    RenderSettings unguided = with_method(base_settings(901), {"", Sampler::bsdf, Nee::one_ray, {}});
    unguided.max_bounces = 2;
    const Rendering truth = render(scene, unguided, 256);
    std::vector<double> variances;
    for (int kind = 0; kind < 3; ++kind) {
      SCOPED_TRACE(testing::Message() << "table " << kind << ", nee " << enum_name(nee));
      RenderSettings settings =
          with_method(base_settings(static_cast<std::uint32_t>(20 + kind)), {"", Sampler::rl, nee, {}});
      settings.max_bounces = 2;
      settings.rl.bsdf_fraction = 0;
      settings.rl.bin_floor = 0.3;
      Tracer tracer(device(), scene, settings);
      tracer.set_learning(false);
      tracer.table()->set_values(mutated_table(tracer.table()->values().size(), kind));
      const Rendering r = render(tracer, 256);
      expect_same_image(r, truth, 6 * kLargeBlocks, kLargeBlock);
      variances.push_back(block_estimate(r.image, 0, 0, kSize).variance);
    }
    if (nee != Nee::none) continue;  // there the light samples decide
    EXPECT_GT(variances[1], 1.1 * variances[0]);
    EXPECT_GT(variances[2], 1.1 * variances[0]);
  }
}

}  // namespace
}  // namespace qtrace::test
