// Rooms with one feature each, and the scenes that have them all: every sampler, kind of next event
// estimation and choice of lights beside the independent tracer.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

namespace qtrace::independent {
namespace {

// What has no surface no path meets. The sun of sunlit_bath is met so rarely that after 512 frames the mean
// is known to 17 to 38 %, and pixels are far from normally distributed.
bool can_tell(const std::string& scene, Nee nee) {
  return nee != Nee::none || (shines_on_paths(scene) && scene != "sunlit_bath.glb");
}

class SlowRooms : public testing::TestWithParam<const char*> {};

TEST_P(SlowRooms, EveryMethodAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 1024});
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
      for (const LightChoice lights : {LightChoice::uniform, LightChoice::power, LightChoice::learned}) {
        const bool has_choice = nee != Nee::none;
        if (!can_tell(GetParam(), nee) || (!has_choice && lights != LightChoice::power)) continue;
        const Agreement found =
            comparison.measure(sampler, nee, 512, 0, 0, {}, RandomNumbers::independent, lights);
        EXPECT_TRUE(found.agrees(kQuickChance)) << enum_name(sampler) << " + " << enum_name(nee)
                                                << ", lights " << enum_name(lights) << ": " << found.text();
        EXPECT_EQ(found.non_finite, 0U);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Features, SlowRooms, testing::ValuesIn(kRooms),
                         [](const auto& room) { return std::string(room.param); });
INSTANTIATE_TEST_SUITE_P(Scenes, SlowRooms, testing::Values("sunlit_bath.glb", "lamp_in_fixture.glb"),
                         [](const auto& scene) {
                           const std::string name = scene.param;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace qtrace::independent
