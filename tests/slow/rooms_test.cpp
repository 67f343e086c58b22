// Rooms with one feature each: every sampler, kind of next event estimation and choice of lights beside the
// independent tracer.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

namespace qtrace::independent {
namespace {

class SlowRooms : public testing::TestWithParam<const char*> {};

TEST_P(SlowRooms, EveryMethodAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 1024});
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
      for (const LightChoice lights : {LightChoice::uniform, LightChoice::power, LightChoice::learned}) {
        const bool has_choice = nee != Nee::none;
        if ((!has_choice && lights != LightChoice::power) || (!has_choice && !shines_on_paths(GetParam())))
          continue;
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

}  // namespace
}  // namespace qtrace::independent
