// Surfaces that let rays pass: pictures, shadows and lamps behind them have closed forms.
#include "tests/support/render.h"
#include "tests/support/statistics.h"
#include "tests/support/textured_quad.h"

#include <gtest/gtest.h>

#include <cmath>

namespace qtrace::test {
namespace {

constexpr int kSize = 16;
constexpr double kSigmas = 4;

RenderSettings settings_of(int max_bounces, Nee nee = Nee::none) {
  return square_settings(kSize, max_bounces, nee);
}

void expect_mean(const Scene& scene, const RenderSettings& settings, int frames, double truth) {
  const Rendering r = render(scene, settings, frames);
  const Estimate mean = block_estimate(r.image, 0, 0, kSize);
  EXPECT_NEAR(mean.mean, truth, kSigmas * std::sqrt(mean.variance) + 1e-4 * truth);
  EXPECT_EQ(r.non_finite, 0U);
}

// Black squares with this opacity, one behind the other, before a wall that emits 2.
Scene veils(float opacity, int count) {
  Scene scene = textured_quad();
  scene.materials[0] = lambert(glm::vec3(0));
  scene.materials[0].alpha_mode = AlphaMode::blend;
  scene.materials[0].opacity = opacity;
  for (int i = 1; i < count; ++i) {
    add_quad(scene, {0, 0, -0.1F * static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0}, 0);
  }
  scene.materials.push_back(lambert(glm::vec3(0), glm::vec3(2)));
  add_quad(scene, {-1, -1, -3}, {3, 0, 0}, {0, 3, 0}, 1);
  return scene;
}

TEST(Alpha, WhatStandsBehindShowsByTheRestOfTheOpacity) {
  for (const int count : {1, 2, 5}) {
    SCOPED_TRACE(count);
    expect_mean(veils(0.3F, count), settings_of(0), 256, 2 * std::pow(0.7, count));
  }
}

// Passing takes no scattering event from the path, at any bounce limit.
TEST(Alpha, PassingIsNoScatteringEvent) {
  Scene scene = veils(0.0F, 12);
  expect_mean(scene, settings_of(0), 4, 2);
  expect_mean(scene, settings_of(1, Nee::one_ray), 4, 2);
}

TEST(Alpha, MasksCutWhereTheTextureIsBelowTheCutoff) {
  Scene scene = veils(1, 1);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].alpha_cutoff = 0.5F;
  TextureImage image{"mask", 2, 1, {{0, 0, 0, 30000}, {0, 0, 0, 36000}}};
  set_texture(scene, TextureSlot::base_color, image, {.is_nearest = true});
  const Rendering r = render(scene, settings_of(0), 4);
  for (int i = 0; i < kSize * kSize; ++i) {
    EXPECT_EQ(r.image.mean[static_cast<std::size_t>(i)].r, i % kSize < kSize / 2 ? 2 : 0) << i;
  }
}

// A veil below the lamp takes its opacity from the light, whoever finds it; five veils five times.
TEST(Alpha, ShadowsAreAsDeepAsTheVeil) {
  for (const int count : {1, 5}) {
    for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
      SCOPED_TRACE(std::to_string(count) + " " + std::string(enum_name(nee)));
      LitFloor lit = lit_floor(0.8F, 3, 1, 2);
      Material veil = lambert(glm::vec3(0));
      veil.alpha_mode = AlphaMode::blend;
      veil.opacity = 0.4F;
      lit.scene.materials.push_back(veil);
      const auto material = static_cast<std::uint32_t>(lit.scene.materials.size() - 1);
      for (int i = 0; i < count; ++i) {
        add_quad(lit.scene, {-9, 1.0F + 0.1F * static_cast<float>(i), -9}, {18, 0, 0}, {0, 0, 18}, material);
      }
      lit.scene.camera = look_at({3, 0.5F, 3}, {0.5F, 0, 0.25F}, 1e-4F);
      expect_mean(lit.scene, settings_of(1, nee), nee == Nee::none ? 2048 : 256,
                  lit.radiance(0.5, 0.25) * std::pow(0.6, count));
    }
  }
}

// A lamp of which a third is there sends a third of the light.
TEST(Alpha, ALampShinesByItsOpacity) {
  for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
    SCOPED_TRACE(enum_name(nee));
    LitFloor lit = lit_floor(0.8F, 3, 1, 2);
    for (Material& m : lit.scene.materials) {
      if (m.emission == glm::vec3(0)) continue;
      m.alpha_mode = AlphaMode::blend;
      m.opacity = 0.25F;
    }
    lit.scene.camera = look_at({3, 1, 3}, {0.5F, 0, 0.25F}, 1e-4F);
    expect_mean(lit.scene, settings_of(1, nee), nee == Nee::none ? 2048 : 256,
                0.25 * lit.radiance(0.5, 0.25));
  }
}

}  // namespace
}  // namespace qtrace::test
