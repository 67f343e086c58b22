// The judge of two images, on images made up from known noise.
#include "tests/independent/agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace qtrace::independent {
namespace {

constexpr int kSize = 128;
constexpr double kSigmas = 4;  // a true judge fails a comparison once in 16,000 choices of the seed

struct Pixel {
  double error, variance;
};

// A grey image against the truth, of radiance 1.
Difference made_up(const std::function<Pixel(int x, int y)>& pixel) {
  Difference difference;
  for (int i = 0; i < kSize * kSize; ++i) {
    const Pixel p = pixel(i % kSize, i / kSize);
    difference.mean.emplace_back(p.error);
    difference.variance.emplace_back(p.variance);
    difference.scale.emplace_back(1);
  }
  return difference;
}

void expect_one(const Chi2& chi2) { EXPECT_NEAR(chi2.value, 1, kSigmas * chi2.error); }

TEST(Agreement, NormalNoiseHasChiSquareOne) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Difference noise = made_up([&](int, int) { return Pixel{0.1 * normal(random), 0.01}; });
  const Chi2 pixels = pooled_chi2(noise, 1, kBlock);
  const Chi2 blocks = pooled_chi2(noise, kBlock, kBlocksInPool);
  expect_one(pixels);
  expect_one(blocks);
  EXPECT_NEAR(pixels.error, std::sqrt(2.0 / (kSize * kSize)), 0.1 * pixels.error);
  EXPECT_NEAR(blocks.error, std::sqrt(2.0 * kBlock * kBlock / (kSize * kSize)), 0.2 * blocks.error);
}

// Paths that are found 20 times per pixel, by Poisson's law, and bring all of the light.
TEST(Agreement, RarePathsRaiseThePixelsOwnChiSquareAlone) {
  std::mt19937 random(2);
  std::poisson_distribution<int> found(20);
  const Difference noise = made_up([&](int, int) {
    const int n = found(random);
    return Pixel{n / 20.0 - 1, n / 400.0};
  });
  const Chi2 own = pooled_chi2(noise, 1, 1);
  EXPECT_GT(own.value - 1, 0.1 - kSigmas * own.error);  // 2 g^2 / n = 2 / 20
  EXPECT_GT(own.value - 1, kSigmas * own.error);
  expect_one(pooled_chi2(noise, 1, kBlock));
  expect_one(pooled_chi2(noise, kBlock, kBlocksInPool));
}

// Variances that are told 10 % too low.
TEST(Agreement, PixelsSeeWrongVariances) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Chi2 pixels = pooled_chi2(made_up([&](int, int) { return Pixel{normal(random), 0.9}; }), 1, kBlock);
  EXPECT_NEAR(pixels.value, 1 / 0.9, kSigmas * pixels.error);
  EXPECT_GT(pixels.value - 1, kSigmas * pixels.error);
}

// A third of a pixel's noise too bright here and as much too dark there.
TEST(Agreement, BlocksSeeWhatNeighboursShare) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const Difference shared = made_up([&](int x, int y) {
    const double sign = (x / 16 + y / 16) % 2 == 0 ? 1 : -1;
    return Pixel{sign / 3 + normal(random), 1};
  });
  const Chi2 blocks = pooled_chi2(shared, kBlock, kBlocksInPool);
  EXPECT_NEAR(blocks.value, 1 + kBlock * kBlock / 9.0, kSigmas * blocks.error);
  EXPECT_GT(blocks.value - 1, 2 * kSigmas * blocks.error);
}

TEST(Agreement, PixelsWithoutNoiseMustBeTheSame) {
  Agreement agreement;
  agreement.mean_ratio = 1;
  agreement.mean_ratio_error = 1e-6;
  agreement.pixels = pooled_chi2(made_up([](int, int) { return Pixel{1e-6, 0}; }), 1, kBlock);
  EXPECT_EQ(agreement.pixels.value, 1);
  EXPECT_TRUE(agreement.agrees(1e-4));
  agreement.pixels = pooled_chi2(made_up([](int, int) { return Pixel{1e-3, 0}; }), 1, kBlock);
  EXPECT_FALSE(agreement.agrees(1e-4)) << agreement.text();
}

TEST(Agreement, EveryFigureCounts) {
  Agreement one;
  one.pixels = one.blocks = {1.02, 0.01};
  one.mean_ratio = 1.002;
  one.mean_ratio_error = 0.001;
  EXPECT_TRUE(one.agrees(1e-4));
  Agreement off = one;
  off.pixels.value = 1.05;
  EXPECT_FALSE(off.agrees(1e-4));
  off = one;
  off.blocks.value = 0.95;
  EXPECT_FALSE(off.agrees(1e-4));
  off = one;
  off.mean_ratio = 0.995;
  EXPECT_FALSE(off.agrees(1e-4));
}

}  // namespace
}  // namespace qtrace::independent
