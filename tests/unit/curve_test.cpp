// Slopes and times to an error, from curves with known answers.
#include "experiments/records/ratios.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace qtrace::experiments {
namespace {

// error = 8 spp^exponent, a second and a half per sample.
Curve power_curve(double exponent, double scale = 8) {
  Curve curve;
  for (const double spp : {1, 2, 4, 8, 16}) {
    curve.push_back({spp, 1.5 * spp, scale * std::pow(spp, exponent), false});
  }
  return curve;
}

TEST(Curve, SlopeIsTheExponent) {
  EXPECT_NEAR(*loglog_slope(power_curve(-1)), -1, 1e-12);
  EXPECT_NEAR(*loglog_slope(power_curve(-0.5)), -0.5, 1e-12);
}

TEST(Curve, PointsAtTheFloorAreNoPartOfTheSlope) {
  Curve curve = power_curve(-1);
  curve[4].error = curve[3].error;  // the reference's noise
  EXPECT_GT(*loglog_slope(curve), -0.95);
  curve[4].at_floor = true;
  EXPECT_NEAR(*loglog_slope(curve), -1, 1e-12);
  curve[3].at_floor = curve[2].at_floor = true;
  EXPECT_FALSE(loglog_slope(curve).has_value());
}

TEST(Curve, TimesAreInterpolatedInLogarithms) {
  const Curve curve = power_curve(-1);
  EXPECT_NEAR(*time_to_error(curve, 8 / 3.0), 4.5, 1e-12);  // three samples
  EXPECT_DOUBLE_EQ(*time_to_error(curve, 2), 6);
  EXPECT_FALSE(time_to_error(curve, 0.49).has_value());  // never
  EXPECT_FALSE(time_to_error(curve, 9).has_value());     // before the first snapshot
}

TEST(Curve, ErrorAfterSomeSecondsIsReadBetweenPoints) {
  const Curve curve{{1, 2, 8}, {2, 4, 2}, {4, 9, 1}};
  EXPECT_EQ(error_after(curve, 4), 2);
  EXPECT_NEAR(*error_after(curve, std::sqrt(8.0)), 4, 1e-12);  // halfway in both logarithms
  EXPECT_NEAR(*error_after(curve, 6), std::sqrt(2.0), 1e-12);
  EXPECT_EQ(error_after(curve, 9), 1);
  EXPECT_FALSE(error_after(curve, 1.9).has_value());  // before the first snapshot
  EXPECT_FALSE(error_after(curve, 9.1).has_value());  // after the last one
  EXPECT_FALSE(error_after({{1, 2, 8}, {2, 4, -1}}, 3).has_value()) << "less than the reference's noise";
}

TEST(Curve, TheMeanCanLeaveOneOut) {
  const std::vector<Curve> curves{power_curve(-1, 1), power_curve(-1, 2), power_curve(-1, 6)};
  EXPECT_DOUBLE_EQ(mean_curve(curves)[1].error, 1.5);
  EXPECT_DOUBLE_EQ(mean_curve(curves, 2)[1].error, 0.75);
  EXPECT_DOUBLE_EQ(mean_curve(curves)[1].seconds, 3);
}

TEST(Ratio, OfMeansWithWelchsInterval) {
  // Means 6 and 2; relative standard errors of the means 1/6 and 1/2; one degree of freedom each.
  const Interval ratio = *ratio_of_means(*estimate({5, 7}), *estimate({1, 3}));
  EXPECT_DOUBLE_EQ(ratio.value, 3);
  const double variance = 1 / 36.0 + 1 / 4.0;
  const double degrees = variance * variance / (std::pow(1 / 36.0, 2) + std::pow(1 / 4.0, 2));
  EXPECT_NEAR(degrees, 100 / 82.0, 1e-12);
  EXPECT_NEAR(*ratio.high, 3 * std::exp(t_quantile(degrees) * std::sqrt(variance)), 1e-6);
  EXPECT_NEAR(*ratio.low * *ratio.high, 9, 1e-12);
  EXPECT_FALSE(ratio_of_means(*estimate({5}), *estimate({1, 3}))->low.has_value());
  EXPECT_FALSE(ratio_of_means(*estimate({0, 0}), *estimate({1, 3})).has_value());
}

// The jackknife of a mean is its standard error.
TEST(Ratio, JackknifeOfAMeanIsTheTextbooks) {
  const std::vector<double> values{1, 2, 4};
  const Interval found = jackknife(7 / 3.0, {3, 2.5, 1.5}, {});
  const Estimate mean = *signed_estimate(values);
  EXPECT_NEAR(std::log(*found.high), *mean.high, 1e-12);
  EXPECT_NEAR(std::log(*found.low), *mean.low, 1e-12);
}

// Errors that scatter by 20 % from seed to seed and seconds by 5 %: of 2000 intervals 92 to 98 % hold the
// time of the true curve; the share has a standard error of 0.5 %.
TEST(Ratio, IntervalsCoverTheTimeToAnError) {
  std::mt19937_64 random(11);
  std::lognormal_distribution<double> scatter(-0.02, 0.2);
  std::normal_distribution<double> jitter(1, 0.05);
  for (const std::size_t seeds : {5U, 10U}) {
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      std::vector<Curve> curves;
      for (std::size_t k = 0; k < seeds; ++k) {
        curves.push_back(power_curve(-1));
        const double speed = jitter(random);
        for (CurvePoint& point : curves.back()) {
          point.error *= scatter(random);
          point.seconds *= speed;
        }
      }
      const auto time = time_to_error(curves, 8 / 5.0);
      if (time && time->low && *time->low <= 7.5 && 7.5 <= *time->high) ++hits;
    }
    EXPECT_GE(hits, 0.92 * 2000) << seeds;
    EXPECT_LE(hits, 0.98 * 2000) << seeds;
  }
}

}  // namespace
}  // namespace qtrace::experiments
