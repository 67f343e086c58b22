// Paths from the lights in every room with one feature each and in two scenes that have them all: every
// sampler, with and without next event estimation, and every choice of lights, beside the independent tracer.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

#include <string>

namespace qtrace::independent {
namespace {

class SlowLightPaths : public testing::TestWithParam<const char*> {};

TEST_P(SlowLightPaths, EveryMethodAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 1024});
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const Nee nee : {Nee::none, Nee::one_ray}) {
      for (const LightChoice lights : {LightChoice::uniform, LightChoice::power, LightChoice::learned}) {
        if (nee == Nee::none && (lights != LightChoice::power || !shines_on_paths(GetParam()))) continue;
        const Agreement found = comparison.measure_light_paths(sampler, nee, 32, lights);
        EXPECT_TRUE(found.agrees(kQuickChance)) << enum_name(sampler) << " + " << enum_name(nee)
                                                << ", lights " << enum_name(lights) << ": " << found.text();
        EXPECT_EQ(found.non_finite, 0U);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Features, SlowLightPaths, testing::ValuesIn(kRooms),
                         [](const auto& room) { return std::string(room.param); });
INSTANTIATE_TEST_SUITE_P(Scenes, SlowLightPaths,
                         testing::Values("cornell_box.glb", "open_sky.glb", "glossy", "lamp_in_fixture.glb"),
                         [](const auto& scene) {
                           const std::string name = scene.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace qtrace::independent
