// Weights of all ways to make a path, for every sampler, with and without next event estimation.
#include "tests/independent/path_weights.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>

namespace qtrace::independent {
namespace {

class SlowPathWeights : public testing::TestWithParam<std::tuple<const char*, Sampler, Nee, LightPaths>> {};

std::string name_of(const testing::TestParamInfo<SlowPathWeights::ParamType>& c) {
  const auto& [room, sampler, nee, paths] = c.param;
  return fmt::format("{}_{}_{}_{}", room, enum_name(sampler), enum_name(nee), enum_name(paths));
}

TEST_P(SlowPathWeights, SumToOne) {
  const auto& [room, sampler, nee, paths] = GetParam();
  expect_sums_of_one(room, sampler, nee, paths);
}

INSTANTIATE_TEST_SUITE_P(Rooms, SlowPathWeights,
                         testing::Combine(testing::Values("normals", "mirror", "rough_glass"),
                                          testing::Values(Sampler::bsdf, Sampler::rl),
                                          testing::Values(Nee::none, Nee::one_ray),
                                          testing::Values(LightPaths::trace, LightPaths::connect)),
                         name_of);

}  // namespace
}  // namespace qtrace::independent
