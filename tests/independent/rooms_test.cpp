// Rooms with one feature each beside the independent tracer, by two methods of the three that between them
// draw light in every way. Every method: tests/slow/rooms_test.cpp.
#include "tests/independent/comparison.h"
#include "tests/independent/feature_rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

namespace qtrace::independent {
namespace {

class Rooms : public testing::TestWithParam<const char*> {};

// Half of the rooms are seen by paths alone, the others by light samples of the paper's kind.
std::pair<Sampler, Nee> without_table(std::string_view room) {
  const bool is_even = (std::ranges::find(kRooms, room) - kRooms.begin()) % 2 == 0;
  if (is_even && shines_on_paths(room)) return {Sampler::bsdf, Nee::none};
  return {Sampler::uniform, Nee::two_ray};
}

TEST_P(Rooms, WithAndWithoutATableAgree) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 256});
  for (const auto& [sampler, nee] : {without_table(GetParam()), std::pair(Sampler::rl, Nee::one_ray)}) {
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
