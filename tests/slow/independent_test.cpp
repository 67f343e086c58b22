// Every shipped scene, sampler and kind of next event estimation beside the independent tracer.
#include "tests/independent/comparison.h"

#include <fmt/format.h>

#include <gtest/gtest.h>
#include <cstdio>

namespace qtrace::independent {
namespace {

constexpr double kPrecision =
    1e-3;  // of the mean's ratio: three standard errors are compared where it is reached
constexpr double kChance = 1e-4;
// Where the most is not enough, the precision that was reached is printed: without next event estimation,
// small lights are found by chance alone.
constexpr int kSize = 128;  // 1024 blocks
constexpr int kSamples = 1 << 10, kMostSamples = 1 << 14;
constexpr int kFrames = 1 << 11, kMostFrames = 1 << 14;

class SlowIndependent : public testing::TestWithParam<const char*> {};

TEST_P(SlowIndependent, EveryMethodAgrees) {
  const Comparison comparison(
      GetParam(),
      {.size = kSize, .samples = kSamples, .most_samples = kMostSamples, .precision = kPrecision});
  fmt::print("{}: {} samples per pixel of the independent tracer\n", GetParam(), comparison.samples());
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
      const Agreement found = comparison.measure(sampler, nee, kFrames, kMostFrames, kPrecision);
      const std::string line =
          fmt::format("| {} | {} | {} | {} |", GetParam(), enum_name(sampler), enum_name(nee), found.text());
      fmt::print("{}\n", line);
      std::fflush(stdout);
      EXPECT_TRUE(found.agrees(kChance)) << line;
      EXPECT_NEAR(found.pixels.value, 1, 0.1) << line;
      EXPECT_EQ(found.non_finite, 0U);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SlowIndependent, testing::ValuesIn(kScenes), [](const auto& scene) {
  const std::string name = scene.param;
  return name.substr(0, name.find('.'));
});

}  // namespace
}  // namespace qtrace::independent
