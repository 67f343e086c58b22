#include "experiments/measure/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace qtrace::experiments {
namespace {

TEST(Statistics, QuantilesInterpolateLikeNumpy) {
  const std::vector<double> values{4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(*quantile(values, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(*quantile(values, 0.1), 1.3);
  EXPECT_DOUBLE_EQ(*quantile(values, 0.9), 3.7);
  EXPECT_DOUBLE_EQ(*quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(*quantile(values, 1), 4);
  EXPECT_DOUBLE_EQ(*quantile({7}, 0.9), 7);
  EXPECT_DOUBLE_EQ(*quantile({5, 1, 9}, 0.5), 5);
  EXPECT_FALSE(quantile({}, 0.5).has_value());
}

TEST(Statistics, SignedIntervalsUseStudentsT) {
  // Two values: mean 2, standard error 1, t(0.975, 1) = 12.7062.
  const Estimate two = *signed_estimate({1, 3});
  EXPECT_DOUBLE_EQ(two.mean, 2);
  EXPECT_NEAR(*two.low, 2 - 12.7062, 1e-4);
  EXPECT_NEAR(*two.high, 2 + 12.7062, 1e-4);
  // Five values 1 ... 5: standard deviation sqrt(2.5), t(0.975, 4) = 2.77645.
  const Estimate five = *signed_estimate({1, 2, 3, 4, 5});
  EXPECT_DOUBLE_EQ(*five.sd, std::sqrt(2.5));
  EXPECT_NEAR(*five.high, 3 + 2.776445 * std::sqrt(2.5 / 5), 1e-5);
  EXPECT_EQ(five.count, 5U);
}

TEST(Statistics, IntervalsOfPositiveFiguresAreSymmetricAboutTheLogarithm) {
  // Mean 2, deviation 1, standard error 1/sqrt(3), t with two degrees 4.302653.
  const Estimate three = *estimate({1, 2, 3});
  const double factor = std::exp(4.302653 / std::sqrt(3) / 2);
  EXPECT_DOUBLE_EQ(three.mean, 2);
  EXPECT_NEAR(*three.low, 2 / factor, 1e-6);
  EXPECT_NEAR(*three.high, 2 * factor, 1e-5);
  EXPECT_EQ(*estimate({0, 0})->high, 0);
}

TEST(Statistics, OneValueHasNoInterval) {
  EXPECT_EQ(estimate({4})->mean, 4);
  EXPECT_FALSE(estimate({4})->low.has_value());
  EXPECT_FALSE(signed_estimate({4})->sd.has_value());
  EXPECT_FALSE(estimate({}).has_value());
}

TEST(Statistics, EqualValuesHaveAnIntervalOfNothing) {
  EXPECT_EQ(*estimate({2, 2, 2})->low, 2);
  EXPECT_EQ(*estimate({2, 2, 2})->high, 2);
}

// Errors as skewed as the mean of few heavy samples leaves them: lognormal. Of 4000 intervals 95 % hold the
// mean; the share has a standard error of 0.35 %, so 92 and 98 % are eight of them away.
TEST(Statistics, IntervalsCoverTheMeanOfSkewedErrors) {
  std::mt19937_64 random(7);
  for (const double sigma : {0.1, 0.3}) {
    for (const std::size_t seeds : {5U, 10U}) {
      std::lognormal_distribution<double> errors(0, sigma);
      int hits = 0;
      for (int i = 0; i < 4000; ++i) {
        std::vector<double> values(seeds);
        for (double& value : values) value = errors(random);
        const Estimate found = *estimate(values);
        const double mean = std::exp(sigma * sigma / 2);
        if (*found.low <= mean && mean <= *found.high) ++hits;
      }
      EXPECT_GE(hits, 0.92 * 4000) << sigma << ' ' << seeds;
      EXPECT_LE(hits, 0.98 * 4000) << sigma << ' ' << seeds;
    }
  }
}

}  // namespace
}  // namespace qtrace::experiments
