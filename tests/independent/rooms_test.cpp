// Rooms with one feature each: every sampler and kind of next event estimation beside the independent tracer.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

namespace qtrace::independent {
namespace {

class Rooms : public testing::TestWithParam<const char*> {};

TEST_P(Rooms, EveryMethodAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 512});
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
      // Paths alone meet no light without a surface.
      if (nee == Nee::none && std::string_view(GetParam()) == "punctual") continue;
      const Agreement found = comparison.measure(sampler, nee, 256);
      EXPECT_TRUE(found.agrees(kQuickChance))
          << enum_name(sampler) << " + " << enum_name(nee) << ": " << found.text();
      EXPECT_EQ(found.non_finite, 0U);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Features, Rooms, testing::ValuesIn(kRooms),
                         [](const auto& room) { return std::string(room.param); });

}  // namespace
}  // namespace qtrace::independent
