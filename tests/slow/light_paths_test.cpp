// Paths from the lights, traced and connected, in every room with one feature each and in two scenes that
// have them all: every sampler, with and without next event estimation, and every choice of lights, beside
// the independent tracer.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace qtrace::independent {
namespace {

std::vector<std::pair<Nee, LightChoice>> ways_to_light(const std::string& scene) {
  std::vector<std::pair<Nee, LightChoice>> ways;
  if (shines_on_paths(scene)) ways.emplace_back(Nee::none, LightChoice::power);
  for (const LightChoice lights : {LightChoice::uniform, LightChoice::power, LightChoice::learned})
    ways.emplace_back(Nee::one_ray, lights);
  return ways;
}

class SlowLightPaths : public testing::TestWithParam<const char*> {};

TEST_P(SlowLightPaths, EveryMethodAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 1024});
  for (const LightPaths paths : {LightPaths::trace, LightPaths::connect}) {
    for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
      for (const auto& [nee, lights] : ways_to_light(GetParam())) {
        const Agreement found = comparison.measure_light_paths(sampler, nee, paths, 32, lights);
        EXPECT_TRUE(found.agrees(kQuickChance))
            << enum_name(paths) << ", " << enum_name(sampler) << " + " << enum_name(nee) << ", lights "
            << enum_name(lights) << ": " << found.text();
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
