// FLIP on images so small that its value can be worked out by hand. tests/analysis/test_metrics.py compares
// larger ones with an implementation of its own.
#include "experiments/measure/flip.h"
#include "engine/core/check.h"
#include "experiments/measure/ldr_flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace qtrace::experiments {
namespace {

DisplayImage row(const std::vector<glm::dvec3>& pixels) {
  return {static_cast<int>(pixels.size()), 1, pixels};
}

RadianceImage grey(const std::vector<double>& values) {
  RadianceImage image{static_cast<int>(values.size()), 1, 0, {}, {}};
  for (const double value : values) image.mean.emplace_back(value);
  return image;
}

const glm::dvec3 kBlack(0.0), kFullWhite(1.0);

// One pixel: filters leave it as it is, there is no edge, and only the colour counts.
// White against black: L* 100 against 0, no chroma: HyAB 100, 100^0.7 = 25.11886.
// The largest difference, Hunt-adjusted L*a*b*: green (87.736, -75.610, 72.981), blue (32.298, 25.578,
// -34.836): 55.438 + |(101.188, 107.818)| = 55.438 + 147.864 = 203.302; 203.302^0.7 = 41.27610, its knee at
// 0.4: 16.51044. 0.95 + 0.05 (25.11886 - 16.51044) / (41.27610 - 16.51044) = 0.967380.
TEST(FlipLdr, WhiteAgainstBlack) {
  EXPECT_NEAR(ldr_flip(row({kFullWhite}), row({kBlack}))[0], 0.967380, 1e-6);
}

TEST(FlipLdr, GreenAgainstBlueIsTheLargestDifference) {
  EXPECT_NEAR(ldr_flip(row({{0, 1, 0}}), row({{0, 0, 1}}))[0], 1, 1e-12);
}

// Below the knee. Linear grey 0.01: L* = 116 0.01^(1/3) - 16 = 8.99144 against 0; 8.99144^0.7 = 4.65244;
// 0.95 / 16.51044 of it: 0.267698.
TEST(FlipLdr, SmallDifferencesAreBelowTheKnee) {
  EXPECT_NEAR(ldr_flip(row({glm::dvec3(0.01)}), row({kBlack}))[0], 0.267698, 1e-6);
}

// A row of black and white against black and black.
// Colour: sigma = 67.0206 sqrt(0.0047 / 2) / pi = 1.03417 pixels, so that the middle weight of the kernel is
// 0.385760. With ends repeated, the left pixel has the half (1 - 0.385760) / 2 = 0.307120 of white in it, the
// right one 0.692880. L*: 62.26375 and 86.64647; to the power 0.7: 18.02871 and 22.72090; as above the knee:
// 0.953065 and 0.962538.
// Features: the edge detector sees, at either pixel, all of one sign on white and all of the other on
// black: 1. sqrt(1 / sqrt(2)) = 0.840896; the point detector sees less. Exponent 1 - 0.840896 = 0.159104.
// 0.953065^0.159104 = 0.992381, 0.962538^0.159104 = 0.993944.
TEST(FlipLdr, AnEdgeThatIsMissing) {
  const std::vector<double> errors = ldr_flip(row({kBlack, kFullWhite}), row({kBlack, kBlack}));
  EXPECT_NEAR(errors[0], 0.992381, 1e-6);
  EXPECT_NEAR(errors[1], 0.993944, 1e-6);
}

TEST(FlipLdr, TheSameAcrossAndDown) {
  const std::vector<glm::dvec3> a{{0, 0.5, 1}, {1, 0.2, 0}, {0.3, 0.3, 0.9}},
      b{{0.1, 0, 0}, kFullWhite, kBlack};
  const std::vector<double> across = ldr_flip({3, 1, a}, {3, 1, b});
  const std::vector<double> down = ldr_flip({1, 3, a}, {1, 3, b});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(across[i], down[i], 1e-12) << i;
}

TEST(FlipLdr, SymmetricAndZeroForEqualImages) {
  const DisplayImage a = row({{0, 0.5, 1}, {1, 0.2, 0}, {0.3, 0.3, 0.9}}),
                     b = row({kBlack, kFullWhite, {1, 0, 1}});
  EXPECT_EQ(ldr_flip(a, b), ldr_flip(b, a));
  EXPECT_EQ(ldr_flip(a, a), std::vector<double>(3, 0.0));
}

// Narkowicz's curve at y = 0.6 x is 0.85 where (2.51 - 0.85 2.43) y^2 + (0.03 - 0.85 0.59) y - 0.85 0.14 = 0:
// 0.4445 y^2 - 0.4715 y - 0.119 = 0, y = 1.271323, x = 2.118872. Luminances 1, 4, 20: the brightest reaches
// it after log2(2.118872 / 20) = -3.238631 stops, the median after log2(2.118872 / 4) = -0.916703. That
// is 2.32 stops, so three exposures.
TEST(FlipHdr, ExposuresFollowTheReference) {
  EXPECT_NEAR(aces(2.118872), 0.85, 1e-7);
  EXPECT_EQ(aces(0), 0);
  EXPECT_EQ(aces(1e300), 1);
  const Exposures exposures = flip_exposures(grey({4, 20, 1}));
  EXPECT_NEAR(exposures.first, -3.238631, 1e-6);
  EXPECT_NEAR(exposures.last, -0.916703, 1e-6);
  EXPECT_EQ(exposures.count, 3);
  EXPECT_NEAR(exposures.stops(1), (-3.238631 - 0.916703) / 2, 1e-6);
  EXPECT_EQ(flip_exposures(grey({1, 1.5})).count, 2);
  EXPECT_EQ(flip_exposures(grey({7, 7})).count, 1);
}

TEST(FlipHdr, ExposuresOfMostlyBlackReferences) {
  EXPECT_EQ(flip_exposures(grey({0, 0, 0})).count, 1);
  const Exposures exposures = flip_exposures(grey({0, 0, 0, 0, 2, 8, 16}));  // the median of 2, 8, 16 counts
  EXPECT_NEAR(exposures.last, std::log2(2.118872 / 8), 1e-6);
}

// Whatever its radiance, a grey reference is shown at 0.85: L* = 116 0.85^(1/3) - 16 = 93.88312; to the power
// 0.7: 24.03318; above the knee 0.95 + 0.05 (24.03318 - 16.51044) / 24.76566 = 0.965188.
TEST(FlipHdr, BlackAgainstGreyIsTheSameAtAnyRadiance) {
  for (const double radiance : {1e-4, 1.0, 1e6}) {
    EXPECT_NEAR(flip_error(grey({0}), grey({radiance})), 0.965188, 1e-6) << radiance;
  }
}

TEST(FlipHdr, ZeroForEqualImagesAndAtMostOne) {
  const RadianceImage a = grey({1e-3, 5, 1e5, 0.2}), b = grey({1e5, 0, 1e-3, 7});
  EXPECT_EQ(flip_error(a, a), 0);
  const std::vector<double> map = flip_map(b, a);
  ASSERT_EQ(map.size(), 4U);
  for (const double error : map) {
    EXPECT_GT(error, 0.5);
    EXPECT_LE(error, 1);
  }
  EXPECT_EQ(flip_error(grey({-1, 1}), grey({0, 1})), 0);  // a screen shows nothing below black
}

TEST(FlipHdr, TheLargestErrorOfAllExposuresCounts) {
  // A light that hides a difference in the shade: at the light's exposure both are black.
  const RadianceImage reference = grey({0.01, 0.01, 0.01, 1e4}), image = grey({0.02, 0.01, 0.01, 1e4});
  EXPECT_GT(flip_map(image, reference)[0], 0.3);
}

TEST(FlipHdr, PixelsThatAreNotFiniteAreLeftOutAndHarmNoOther) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> errors = flip_map(grey({1, nan, 3}), grey({1, 2, 3}));
  EXPECT_EQ(errors[0], 0);
  EXPECT_TRUE(std::isnan(errors[1]));
  EXPECT_EQ(errors[2], 0);
  EXPECT_TRUE(std::isnan(flip_map(grey({1, 2}), grey({nan, 2}))[0]));
  EXPECT_EQ(flip_error(grey({1, nan, 3}), grey({1, 2, 3})), 0);
  EXPECT_TRUE(std::isnan(flip_error(grey({nan}), grey({1}))));
  EXPECT_THROW(flip_map(grey({1}), grey({1, 2})), Error);
}

}  // namespace
}  // namespace qtrace::experiments
