// Bias and variance of images with known ones.
#include "experiments/measure/error_parts.h"

#include <gtest/gtest.h>

#include <random>

namespace qtrace::experiments {
namespace {

RadianceImage grey(const std::vector<double>& values, double variance = 0) {
  RadianceImage image;
  image.width = static_cast<int>(values.size());
  image.height = 1;
  image.samples = 2;
  for (const double value : values) {
    image.mean.emplace_back(value);
    image.variance.emplace_back(variance);
  }
  return image;
}

std::optional<ErrorParts> separate(const std::vector<RadianceImage>& images, const RadianceImage& reference) {
  return separate_errors(
      images.size(), [&](std::size_t i) { return images[i]; }, reference);
}

// One pixel: seeds 1, 2 and 6 (mean 3, variance 7) against 1 with variance 0.5. The mean of the products
// (x_i - r)(x_j - r) over pairs is (0*1 + 0*5 + 1*5) / 3, less 0.5; without each seed it is 5, 0 and 0 less
// 0.5.
TEST(ErrorParts, ByHand) {
  const ErrorParts parts = *separate({grey({1}), grey({2}), grey({6})}, grey({1}, 0.5));
  EXPECT_NEAR(parts.variance, 7, 1e-12);
  EXPECT_NEAR(parts.bias2.mean, 5 / 3.0 - 0.5, 1e-12);
  const double all = 5 / 3.0 - 0.5;
  const Estimate pseudo = *signed_estimate({3 * all - 2 * 4.5, 3 * all + 1, 3 * all + 1});
  EXPECT_NEAR(*parts.bias2.low, *pseudo.low, 1e-12);
  EXPECT_NEAR(*parts.bias2.high, *pseudo.high, 1e-12);
  EXPECT_EQ(parts.abs_bias_low(), 0);
}

TEST(ErrorParts, TwoSeedsHaveNoIntervalAndOneNothing) {
  EXPECT_FALSE(separate({grey({1}), grey({2})}, grey({1}))->abs_bias_low().has_value());
  EXPECT_FALSE(separate({grey({1})}, grey({1})).has_value());
}

// 400 pixels with a bias of 0.3 and a deviation of 1, eight seeds, a reference with a variance of 0.04: of
// 300 intervals at least 90 % hold the bias (standard error 1.3 %), and without bias the estimate scatters
// about 0.
TEST(ErrorParts, IntervalsHoldTheBias) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 1);
  for (const double bias : {0.0, 0.3}) {
    int hits = 0;
    double mean = 0;
    for (int i = 0; i < 300; ++i) {
      std::vector<RadianceImage> images;
      for (int seed = 0; seed < 8; ++seed) {
        std::vector<double> values(400);
        for (double& value : values) value = bias + noise(random);
        images.push_back(grey(values));
      }
      std::vector<double> truth(400);
      for (double& value : truth) value = 0.2 * noise(random);
      const ErrorParts parts = *separate(images, grey(truth, 0.04));
      mean += parts.bias2.mean / 300;
      if (*parts.abs_bias_low() <= bias && bias <= *parts.abs_bias_high()) ++hits;
    }
    EXPECT_GE(hits, 270) << bias;
    EXPECT_NEAR(mean, bias * bias, 0.003) << bias;
  }
}

}  // namespace
}  // namespace qtrace::experiments
