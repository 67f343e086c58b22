// Rooms with one feature each beside the independent tracer. Every method: tests/slow/rooms_test.cpp.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

#include <utility>

namespace qtrace::independent {
namespace {

class Rooms : public testing::TestWithParam<const char*> {};

TEST_P(Rooms, EverySamplerAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 256});
  for (const auto& [sampler, nee] :
       {std::pair(Sampler::bsdf, Nee::none), std::pair(Sampler::uniform, Nee::two_ray),
        std::pair(Sampler::rl, Nee::one_ray)}) {
    if (nee == Nee::none && !shines_on_paths(GetParam())) continue;
    const Agreement found = comparison.measure(sampler, nee, 192);
    EXPECT_TRUE(found.agrees(kQuickChance))
        << enum_name(sampler) << " + " << enum_name(nee) << ": " << found.text();
    EXPECT_EQ(found.non_finite, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Features, Rooms, testing::ValuesIn(kRooms),
                         [](const auto& room) { return std::string(room.param); });

}  // namespace
}  // namespace qtrace::independent
