// All methods estimate the same image, whatever their table holds.
#include "engine/scene/analytic.h"
#include "engine/scene/gltf.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kSize = 64;
constexpr int kBlock = 16;
constexpr int kBlocks = (kSize / kBlock) * (kSize / kBlock);
// Where few paths carry most of the light, larger blocks bring the mean nearer to a normal distribution.
constexpr int kLargeBlock = 32;
constexpr int kLargeBlocks = (kSize / kLargeBlock) * (kSize / kLargeBlock);

RenderSettings base_settings(std::uint32_t seed) {
  RenderSettings settings;
  settings.width = settings.height = kSize;
  settings.max_bounces = 4;
  settings.seed = seed;
  settings.rl.sites_per_object = 40;
  settings.rl.bins_theta = settings.rl.bins_phi = 6;
  return settings;
}

Scene shipped(const char* name) {
  return load_gltf(std::string(QTRACE_SOURCE_DIR) + "/configs/scenes/" + name);
}

// Compares blocks of pixels by their z-scores, at a chance of false alarm shared by `comparisons`.
void expect_same_image(const Rendering& a, const Rendering& b, std::size_t comparisons, int size = kBlock) {
  EXPECT_EQ(a.non_finite, 0U);
  const int row = kSize / size;
  for (int i = 0; i < row * row; ++i) {
    const int x = i % row * size;
    const int y = i / row * size;
    const Estimate ea = block_estimate(a.image, x, y, size);
    const Estimate eb = block_estimate(b.image, x, y, size);
    EXPECT_LT(z_score(ea, eb), z_threshold(comparisons))
        << "block at (" << x << ", " << y << "): " << ea.mean << " +- " << std::sqrt(ea.variance)
        << " against " << eb.mean << " +- " << std::sqrt(eb.variance);
  }
}

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

// A glossy room: metal, plastic, a second, dimmer and double-sided light, and light from outside.
TEST(Agreement, AllMethodsOnGlossyMaterials) {
  Scene scene = shipped("cornell_box.glb");
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.metallic = i % 3 == 0 ? 0.8F : 0.0F;
    m.specular = i % 3 == 1 ? 0.7F : 1.0F;
    m.roughness = i % 2 == 0 ? 0.5F : 0.7F;  // broad enough for uniform directions to find the highlights
  }
  scene.materials.push_back(lambert(glm::vec3(0.2F), glm::vec3(2, 4, 6)));
  scene.materials.back().double_sided = true;
  add_quad(scene, {1.2F, 2, 0}, {0.8F, 0.3F, 0}, {0, 0.8F, 0.4F},
           static_cast<std::uint32_t>(scene.materials.size() - 1));
  expect_all_methods_agree(scene, 96, {0.3, 0.2, 0.1});
}

// Without the BSDF's share, all directions come from what was learned, as in the report.
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
