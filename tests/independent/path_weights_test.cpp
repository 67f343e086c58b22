// Weights of all ways to make a path, where the ways differ most. Every room and method:
// tests/slow/path_weights_test.cpp.
#include "tests/independent/path_weights.h"

#include <gtest/gtest.h>

namespace qtrace::independent {
namespace {

TEST(PathWeights, SumToOneWithBentNormalsAndATable) {
  expect_sums_of_one("normals", Sampler::rl, Nee::one_ray, LightPaths::connect);
}

TEST(PathWeights, SumToOneBehindMirrors) {
  expect_sums_of_one("mirror", Sampler::bsdf, Nee::none, LightPaths::trace);
}

TEST(PathWeights, SumToOneThroughRoughGlassWithATable) {
  expect_sums_of_one("rough_glass", Sampler::rl, Nee::one_ray, LightPaths::connect);
}

}  // namespace
}  // namespace qtrace::independent
