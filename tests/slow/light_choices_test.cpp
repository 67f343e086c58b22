// Every shipped scene beside the independent tracer, with lights chosen in the ways that its table
// (independent_test.cpp) leaves out: uniformly, and as learned.
#include "tests/independent/comparison.h"

#include <gtest/gtest.h>

namespace qtrace::independent {
namespace {

constexpr int kFrames = 1024;

class SlowLightChoices : public testing::TestWithParam<const char*> {};

TEST_P(SlowLightChoices, AllAgree) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 1024});
  for (const LightChoice lights : {LightChoice::uniform, LightChoice::learned}) {
    for (const Sampler sampler : {Sampler::bsdf, Sampler::rl}) {
      for (const Nee nee : {Nee::one_ray, Nee::two_ray}) {
        const Agreement found =
            comparison.measure(sampler, nee, kFrames, 0, 0, {}, RandomNumbers::independent, lights);
        EXPECT_TRUE(found.agrees(kQuickChance)) << enum_name(sampler) << " + " << enum_name(nee)
                                                << ", lights " << enum_name(lights) << ": " << found.text();
        EXPECT_EQ(found.non_finite, 0U);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SlowLightChoices, testing::ValuesIn(kScenes), [](const auto& scene) {
  const std::string name = scene.param;
  return name.substr(0, name.find('.'));
});

}  // namespace
}  // namespace qtrace::independent
