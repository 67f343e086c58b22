// Paths from the lights, weighted against those of the camera, beside the independent tracer: rooms that
// between them need all that such paths do. Every room and method: tests/slow/light_paths_test.cpp.
#include "tests/independent/comparison.h"

#include <gtest/gtest.h>

#include <string>

namespace qtrace::independent {
namespace {

struct Case {
  const char* room;
  Sampler sampler;
  Nee nee;
  LightPaths paths;
};

class LightPathRooms : public testing::TestWithParam<Case> {};

TEST_P(LightPathRooms, AgreesWithTheIndependentTracer) {
  const auto& [room, sampler, nee, paths] = GetParam();
  const Comparison comparison(room, {.size = 32, .samples = 256});
  const Agreement found = comparison.measure_light_paths(sampler, nee, paths, 12);
  EXPECT_TRUE(found.agrees(kQuickChance)) << found.text();
  EXPECT_EQ(found.non_finite, 0U);
}

INSTANTIATE_TEST_SUITE_P(
    Features, LightPathRooms,
    testing::Values(Case{"normals", Sampler::bsdf, Nee::none, LightPaths::trace},
                    Case{"lamp_in_glass", Sampler::bsdf, Nee::one_ray, LightPaths::trace},
                    Case{"in_glass", Sampler::rl, Nee::one_ray, LightPaths::connect},
                    Case{"sky_and_lamp", Sampler::rl, Nee::one_ray, LightPaths::connect}),
    [](const auto& c) { return std::string(c.param.room); });

}  // namespace
}  // namespace qtrace::independent
