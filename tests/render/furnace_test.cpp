// White furnace: in a closed box of albedo rho whose walls emit Le, every pixel shows
// Le (1 - rho^(N+1)) / (1 - rho), whatever the sampler.
#include "engine/scene/analytic.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

constexpr float kAlbedo = 0.6F;
constexpr float kEmission = 1.5F;
constexpr int kMostBounces = 8;
constexpr int kSize = 16;
constexpr int kFrames = 256;
constexpr double kTolerance = 0.005;

RenderSettings furnace_settings(int max_bounces) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = kSize;
  settings.max_bounces = max_bounces;
  settings.seed = 11;
  settings.rl.sites_per_object = 20;
  settings.rl.bins_theta = settings.rl.bins_phi = 4;
  return settings;
}

void expect_furnace(const Method& method, int max_bounces) {
  SCOPED_TRACE(method.name + ", max_bounces " + std::to_string(max_bounces));
  const Scene scene = furnace_box(kAlbedo, kEmission);
  const Rendering r = render(scene, with_method(furnace_settings(max_bounces), method), kFrames);
  EXPECT_EQ(r.non_finite, 0U);
  const Estimate truth{furnace_radiance(kAlbedo, kEmission, max_bounces), 0};
  const Estimate all = block_estimate(r.image, 0, 0, kSize);
  EXPECT_LT(z_score(all, truth), 4) << all.mean << " instead of " << truth.mean;
  EXPECT_NEAR(all.mean / truth.mean, 1, kTolerance);
  const std::size_t comparisons = all_methods().size() * (kMostBounces + 1) * kSize * kSize;
  for (int i = 0; i < kSize * kSize; ++i) {
    const Estimate pixel = block_estimate(r.image, i % kSize, i / kSize, 1);
    EXPECT_LT(z_score(pixel, truth), z_threshold(comparisons))
        << "pixel " << i << ": " << pixel.mean << " +- " << std::sqrt(pixel.variance) << " instead of "
        << truth.mean;
  }
}

class Furnace : public testing::TestWithParam<int> {};

TEST_P(Furnace, EveryMethodShowsTheNeumannSum) {
  for (const Method& method : all_methods()) expect_furnace(method, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Bounces, Furnace, testing::Range(0, kMostBounces + 1));

// Without a light sample and without roulette, each path's sum is the answer itself: any leak or
// self-intersection shows as a pixel that is off.
TEST(FurnaceExact, HoldsAtAnyScaleAndPlace) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    for (const float shift : {0.0F, 100.0F}) {
      SCOPED_TRACE(testing::Message() << "half size " << scale << ", shift " << shift);
      RenderSettings settings = with_method(furnace_settings(5), {});
      settings.russian_roulette_start = 5;
      const Rendering r =
          render(furnace_box(kAlbedo, kEmission, scale, glm::vec3(shift * scale)), settings, 64);
      const double truth = furnace_radiance(kAlbedo, kEmission, 5);
      for (const glm::dvec3& pixel : r.image.mean) EXPECT_NEAR(pixel.g / truth, 1, 1e-5);
    }
  }
}

}  // namespace
}  // namespace qtrace::test
