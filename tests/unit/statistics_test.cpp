#include "experiments/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(Statistics, IntervalsUseStudentsT) {
  // Two values: mean 2, standard error 1, t(0.975, 1) = 12.7062.
  const Estimate two = *estimate({1, 3});
  EXPECT_DOUBLE_EQ(two.mean, 2);
  EXPECT_NEAR(*two.half_width, 12.7062, 1e-4);
  // Five values 1 ... 5: standard deviation sqrt(2.5), t(0.975, 4) = 2.77645.
  const Estimate five = *estimate({1, 2, 3, 4, 5});
  EXPECT_DOUBLE_EQ(five.mean, 3);
  EXPECT_NEAR(*five.half_width, 2.776445 * std::sqrt(2.5 / 5), 1e-5);
  EXPECT_EQ(five.count, 5U);
}

TEST(Statistics, OneValueHasNoInterval) {
  EXPECT_EQ(estimate({4})->mean, 4);
  EXPECT_FALSE(estimate({4})->half_width.has_value());
  EXPECT_FALSE(estimate({}).has_value());
}

TEST(Statistics, EqualValuesHaveAnIntervalOfNothing) { EXPECT_EQ(*estimate({2, 2, 2})->half_width, 0); }

}  // namespace
}  // namespace qtrace::experiments
