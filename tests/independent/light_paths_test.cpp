// Paths from the lights, weighted against those of the camera, beside the independent tracer: rooms with one
// feature each.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

#include <utility>

namespace qtrace::independent {
namespace {

class LightPathRooms : public testing::TestWithParam<const char*> {};

TEST_P(LightPathRooms, EverySamplerAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 256});
  for (const auto& [sampler, nee] :
       {std::pair(Sampler::bsdf, Nee::none), std::pair(Sampler::bsdf, Nee::one_ray),
        std::pair(Sampler::rl, Nee::one_ray)}) {
    if (nee == Nee::none && !shines_on_paths(GetParam())) continue;
    const Agreement found = comparison.measure_light_paths(sampler, nee, 12);
    EXPECT_TRUE(found.agrees(kQuickChance))
        << enum_name(sampler) << " + " << enum_name(nee) << ": " << found.text();
    EXPECT_EQ(found.non_finite, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Features, LightPathRooms, testing::ValuesIn(kRooms),
                         [](const auto& room) { return std::string(room.param); });

}  // namespace
}  // namespace qtrace::independent
