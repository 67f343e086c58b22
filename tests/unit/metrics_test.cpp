// Metrics on tiny images, against values worked out by hand.
#include "experiments/measure/metrics.h"
#include "engine/core/check.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include <cmath>
#include <limits>
#include <random>

namespace qtrace::experiments {
namespace {

// A row of grey pixels.
RadianceImage grey(const std::vector<double>& values, double variance = 0, std::uint64_t samples = 4) {
  RadianceImage image{static_cast<int>(values.size()), 1, samples, {}, {}};
  for (const double value : values) image.mean.emplace_back(value);
  image.variance.assign(values.size(), glm::dvec3(variance));
  return image;
}

TEST(Metrics, TwoGreyPixels) {
  // a - r: 1, -0.5; r: 1, 2.
  const ErrorMetrics errors = compare_images(grey({2, 1.5}), grey({1, 2}));
  EXPECT_DOUBLE_EQ(errors.mse, (1 + 0.25) / 2);
  EXPECT_DOUBLE_EQ(errors.relmse, (1 / 1.01 + 0.25 / 4.01) / 2);
  EXPECT_DOUBLE_EQ(errors.mape, (1 / 1.01 + 0.5 / 2.01) / 2);
  EXPECT_DOUBLE_EQ(errors.bias, 0.25);
  EXPECT_DOUBLE_EQ(errors.relmse_trimmed, 0.25 / 4.01);  // one of two pixels is dropped, the larger error
  EXPECT_EQ(errors.non_finite, 0U);
}

TEST(Metrics, SymmetricPercentage) {
  // |a - r| / (|a| + |r| + 0.01): 1 / 3.01 and 0.5 / 3.51.
  EXPECT_DOUBLE_EQ(compare_images(grey({2, 1.5}), grey({1, 2})).smape, (1 / 3.01 + 0.5 / 3.51) / 2);
  // Channels 0, 1, 3 apart: 0, 1 / (2 + 1 + 0.01) and 3 / (3 + 0 + 0.01).
  RadianceImage image = grey({0}), reference = grey({0});
  image.mean[0] = {1, 2, 3};
  reference.mean[0] = {1, 1, 0};
  EXPECT_DOUBLE_EQ(compare_images(image, reference).smape, (0 + 1 / 3.01 + 3 / 3.01) / 3);
  EXPECT_DOUBLE_EQ(compare_images(reference, image).smape, (0 + 1 / 3.01 + 3 / 3.01) / 3);
  EXPECT_DOUBLE_EQ(compare_images(grey({1}), grey({-1})).smape, 2 / 2.01);
  EXPECT_EQ(compare_images(grey({0}), grey({0})).smape, 0);
}

TEST(Metrics, PeakSignalToNoise) {
  // mse 0.625 as above, the reference's largest value 2: 10 log10(4 / 0.625) = 10 log10(6.4) = 8.0617997.
  EXPECT_NEAR(compare_images(grey({2, 1.5}), grey({1, 2})).psnr_db, 8.0617997, 1e-7);
  // The largest channel: 5, mse (0 + 0 + 1) / 3: 10 log10(75) = 18.7506126.
  RadianceImage image = grey({0}), reference = grey({0});
  reference.mean[0] = {1, 0.5, 5};
  image.mean[0] = {1, 0.5, 4};
  EXPECT_NEAR(compare_images(image, reference).psnr_db, 18.7506126, 1e-7);
  EXPECT_EQ(compare_images(grey({2}), grey({2})).psnr_db, std::numeric_limits<double>::infinity());
}

TEST(Metrics, NineDifferentPixels) {
  // 3x3; a - r is 1 at the centre (r = 2), -1 at a corner (r = 0), 0 elsewhere (r = 1).
  RadianceImage image = grey({1, 1, 1, 1, 3, 1, 1, 1, -1}), reference = grey({1, 1, 1, 1, 2, 1, 1, 1, 0});
  image.width = image.height = reference.width = reference.height = 3;
  const ErrorMetrics errors = compare_images(image, reference);
  EXPECT_NEAR(errors.mse, 2.0 / 9, 1e-15);
  EXPECT_NEAR(errors.relmse, (1 / 4.01 + 1 / 0.01) / 9, 1e-12);
  EXPECT_NEAR(errors.relmse_trimmed, 1 / 4.01 / 8, 1e-15);
  EXPECT_NEAR(errors.mape, (1 / 2.01 + 1 / 0.01) / 9, 1e-12);
  EXPECT_NEAR(errors.smape, (1 / 5.01 + 1 / 1.01) / 9, 1e-15);
  EXPECT_NEAR(errors.psnr_db, 12.5527251, 1e-7);  // 10 log10(2^2 / (2 / 9)) = 10 log10(18)
  EXPECT_EQ(errors.bias, 0);
}

TEST(Metrics, ChannelsAreAveragedWithinAPixel) {
  RadianceImage image = grey({0});
  RadianceImage reference = grey({0});
  image.mean[0] = {1, 2, 3};
  reference.mean[0] = {1, 1, 0};
  const ErrorMetrics errors = compare_images(image, reference);
  EXPECT_DOUBLE_EQ(errors.mse, (0.0 + 1 + 9) / 3);
  EXPECT_DOUBLE_EQ(errors.relmse, (0 + 1 / 1.01 + 9 / 0.01) / 3);
  EXPECT_DOUBLE_EQ(errors.mape, (0 + 1 / 1.01 + 3 / 0.01) / 3);
  EXPECT_DOUBLE_EQ(errors.bias, (0.0 + 1 + 3) / 3);
}

TEST(Metrics, NegativeReferencesAreMeasuredByTheirSize) {
  EXPECT_DOUBLE_EQ(compare_images(grey({0}), grey({-1})).mape, 1 / 1.01);
}

TEST(Metrics, TrimmingDropsATenthOfAPercentRoundedUp) {
  // 2000 pixels: two are dropped, and three are wrong by far.
  std::vector<double> values(2000, 1.1);
  values[7] = values[100] = values[1999] = 101;
  const ErrorMetrics errors = compare_images(grey(values), grey(std::vector<double>(2000, 1.0)));
  EXPECT_NEAR(errors.relmse_trimmed, (1997 * 0.01 + 10000) / 1.01 / 1998, 1e-9);
  // 2001 pixels: three.
  values.push_back(1.1);
  const ErrorMetrics more = compare_images(grey(values), grey(std::vector<double>(2001, 1.0)));
  EXPECT_NEAR(more.relmse_trimmed, 0.01 / 1.01, 1e-12);
}

TEST(Metrics, TrimmingKeepsASinglePixel) {
  EXPECT_DOUBLE_EQ(compare_images(grey({2}), grey({1})).relmse_trimmed, 1 / 1.01);
}

TEST(Metrics, ReferenceNoiseStandsBesideTheError) {
  const ErrorMetrics errors = compare_images(grey({1, 2}), grey({1, 2}, 0.5));
  ASSERT_TRUE(errors.reference.has_value());
  EXPECT_DOUBLE_EQ(errors.reference->mse, 0.5);
  EXPECT_DOUBLE_EQ(errors.reference->relmse, (0.5 / 1.01 + 0.5 / 4.01) / 2);
  EXPECT_TRUE(errors.at_reference_floor());
}

TEST(Metrics, FloorIsThreeTimesTheNoise) {
  // One pixel, error 1: mse 1, relmse 1 / 1.01; the noise is v and v / 1.01.
  EXPECT_TRUE(compare_images(grey({2}), grey({1}, 1.0 / 3 + 1e-9)).at_reference_floor());
  EXPECT_FALSE(compare_images(grey({2}), grey({1}, 1.0 / 3 - 1e-9)).at_reference_floor());
}

// An image at a known distance from the truth, against references of independent normal noise whose variance
// is estimated from their own samples: the correction takes out what the noise adds.
TEST(Metrics, CorrectedErrorsAreThoseAgainstTheTruth) {
  constexpr int kTrials = 4000, kSamples = 4;
  constexpr double kDeviation = 0.1;
  const std::vector<double> truth{1, 2, 3, 4}, shown{1.1, 2, 2.8, 4.1};
  const ErrorMetrics exact = compare_images(grey(shown), grey(truth));
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, kDeviation);
  double mse = 0, squares = 0, relmse = 0, measured = 0, measured_relmse = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    RadianceImage reference = grey(truth, 0, kSamples);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      double sum = 0, sum_of_squares = 0;
      for (int s = 0; s < kSamples; ++s) {
        const double sample = truth[i] + normal(random);
        sum += sample;
        sum_of_squares += sample * sample;
      }
      const double mean = sum / kSamples;
      reference.mean[i] = glm::dvec3(mean);
      reference.variance[i] = glm::dvec3((sum_of_squares - sum * mean) / (kSamples - 1) / kSamples);
    }
    const ErrorMetrics errors = compare_images(grey(shown), reference);
    mse += *errors.mse_corrected() / kTrials;
    squares += *errors.mse_corrected() * *errors.mse_corrected() / kTrials;
    relmse += *errors.relmse_corrected() / kTrials;
    measured += errors.mse / kTrials;
    measured_relmse += errors.relmse / kTrials;
  }
  const double standard_error = std::sqrt((squares - mse * mse) / kTrials);
  EXPECT_LT(std::abs(mse - exact.mse), test::z_threshold(2) * standard_error);
  EXPECT_LT(std::abs(measured - exact.mse - kDeviation * kDeviation / kSamples),
            test::z_threshold(2) * standard_error);
  EXPECT_GT(measured - exact.mse, 10 * standard_error);   // else the test would show nothing
  EXPECT_NEAR(relmse, exact.relmse, 0.1 * exact.relmse);  // what is of second order in the noise stays
  EXPECT_GT(measured_relmse, 1.2 * exact.relmse);
}

TEST(Metrics, CorrectedErrorsMayBeNegative) {
  const ErrorMetrics errors = compare_images(grey({1, 1}), grey({1, 1}, 0.5));
  EXPECT_EQ(errors.mse_corrected(), -0.5);
  EXPECT_EQ(errors.relmse_corrected(), -0.5 / 1.01);
}

TEST(Metrics, OneSampleHasNoKnownNoise) {
  const ErrorMetrics errors = compare_images(grey({1}), grey({1}, 0, 1));
  EXPECT_FALSE(errors.reference.has_value());
  EXPECT_FALSE(errors.mse_corrected().has_value());
  EXPECT_FALSE(errors.relmse_corrected().has_value());
  EXPECT_FALSE(errors.at_reference_floor());
}

TEST(Metrics, NonFinitePixelsAreCountedAndLeftOut) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const ErrorMetrics errors = compare_images(grey({nan, 2, 1}), grey({1, 1, inf}));
  EXPECT_EQ(errors.non_finite, 2U);
  EXPECT_DOUBLE_EQ(errors.mse, 1);
  EXPECT_TRUE(std::isnan(compare_images(grey({nan}), grey({1})).mse));
  EXPECT_TRUE(std::isnan(compare_images(grey({nan}), grey({1})).relmse_trimmed));
}

TEST(Metrics, SizesMustAgree) { EXPECT_THROW(compare_images(grey({1}), grey({1, 2})), Error); }

TEST(Metrics, BlackAgainstBlackIsNoError) {
  const ErrorMetrics errors = compare_images(grey({0, 0}), grey({0, 0}));
  EXPECT_EQ(errors.relmse, 0);
  EXPECT_EQ(errors.mape, 0);
}

TEST(Metrics, DefinitionsStateTheirConstants) {
  const auto formula = [](const char* name) { return error_metric(name).formula; };
  EXPECT_EQ(formula("relmse"), "mean((a - r)^2 / (r^2 + 0.01))");
  EXPECT_NE(formula("relmse_trimmed").find("0.1 %"), std::string::npos);
  EXPECT_NE(formula("at_reference_floor").find("3 * reference_relmse"), std::string::npos);
}

TEST(Metrics, TheListHasEveryNumberOfAComparison) {
  ErrorMetrics errors;
  errors.mse = 1;
  errors.smape = 5;
  errors.flip = 7;
  errors.non_finite = 9;
  errors.reference = ReferenceNoise{0.25, 0.5};
  const auto number = [&](const char* name) { return error_metric(name).number(errors); };
  EXPECT_EQ(number("mse"), 1);
  EXPECT_EQ(number("smape"), 5);
  EXPECT_EQ(number("flip"), 7);
  EXPECT_EQ(number("mse_corrected"), 0.75);
  EXPECT_EQ(number("reference_relmse"), 0.5);
  EXPECT_EQ(error_metric("non_finite_pixels").value(errors), CsvValue(std::uint64_t{9}));
  EXPECT_EQ(error_metric("at_reference_floor").value(errors), CsvValue(true)) << "relmse 0 <= 3 * 0.5";
  errors.flip.reset();
  EXPECT_EQ(error_metric("flip").value(errors), CsvValue());
  std::set<std::string> names;
  for (const Metric& metric : error_metrics()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_FALSE(metric.label.empty() || metric.formula.empty() || metric.source.empty()) << metric.name;
  }
}

TEST(Metrics, AnUnknownNameIsAnError) { EXPECT_THROW(error_metric("rmse"), Error); }

}  // namespace
}  // namespace qtrace::experiments
