// Verdicts over images that are made up.
#include "experiments/measure/expectation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace qtrace::experiments {
namespace {

constexpr double kDeviation = 0.1;  // of every channel of every pixel

// 8 x 8 pixels of one radiance: the mean of all has a standard error of 0.1 / 8, that of a block 0.1 / 2.
RadianceImage flat(double radiance, double deviation = kDeviation) {
  RadianceImage image{8, 8, 16, {}, {}};
  image.mean.assign(64, glm::dvec3(radiance));
  image.variance.assign(64, glm::dvec3(deviation * deviation));
  return image;
}

Expectation against(Against truth, double mean = 0) {
  Expectation expect;
  expect.against = truth;
  expect.mean = mean;
  return expect;
}

TEST(Expectation, NothingExpectedMeansNoVerdict) {
  EXPECT_FALSE(judge(Expectation{}, flat(1), flat(2), 7).has_value());
}

// Both images are noisy: their difference has a standard error of sqrt(2) 0.1 / 8 = 0.0177.
TEST(Expectation, TheReferenceDecidesWithinStandardErrors) {
  const auto near = judge(against(Against::reference), flat(1.0), flat(1.08), 0);
  EXPECT_EQ(near->word, "pass");
  EXPECT_NEAR(near->worst_z, (0.08 - 1.08e-4) / (kDeviation / 8 * std::sqrt(2.0)), 1e-6);
  EXPECT_NEAR(near->mean_error, kDeviation / 8, 1e-12);
  EXPECT_NEAR(near->expected, 1.08, 1e-12);
  const auto far = judge(against(Against::reference), flat(1.0), flat(1.1), 0);
  EXPECT_EQ(far->word, "fail");
  EXPECT_EQ(far->reason.substr(0, 59), "the mean of the image is 1 and that of the reference 1.1: 5");
}

// The mean of all is right, but one block is bright and another dark.
TEST(Expectation, BlocksAreComparedToo) {
  RadianceImage image = flat(1);
  for (const int x : {0, 1}) {
    for (const int y : {6, 7}) {
      image.mean[static_cast<std::size_t>(y * 8 + x)] += glm::dvec3(0.4);
      image.mean[static_cast<std::size_t>(y * 8 + 4 + x)] -= glm::dvec3(0.4);
    }
  }
  const auto verdict = judge(against(Against::reference), image, flat(1), 0);
  EXPECT_EQ(verdict->word, "fail");
  EXPECT_NE(verdict->reason.find("block (2, 3) of 4 x 4"), std::string::npos) << verdict->reason;
}

TEST(Expectation, AKnownMeanIsAskedBesidesTheReference) {
  EXPECT_EQ(judge(against(Against::mean, 1.01), flat(1), flat(1), 0)->word, "pass");
  EXPECT_EQ(judge(against(Against::mean, 1.1), flat(1), flat(1), 0)->word, "fail");
  EXPECT_EQ(judge(against(Against::mean, 1), flat(1), flat(2), 0)->word, "fail");
}

TEST(Expectation, WithoutNoiseTheToleranceDecides) {
  Expectation expect = against(Against::mean, 1);
  EXPECT_EQ(judge(expect, flat(1.00009, 0), flat(1, 0), 0)->word, "pass");
  EXPECT_EQ(judge(expect, flat(1.00011, 0), flat(1, 0), 0)->word, "fail");
  expect.tolerance = 0.01;
  EXPECT_EQ(judge(expect, flat(1.0099, 0), flat(1, 0), 0)->word, "pass");
}

TEST(Expectation, WhereNoLightCanBeNoneMay) {
  RadianceImage image = flat(0, 0);
  EXPECT_EQ(judge(against(Against::mean, 0), image, flat(0, 0), 0)->word, "pass");
  image.mean[5].g = 1e-6;
  image.variance[5].g = 1;
  const auto verdict = judge(against(Against::mean, 0), image, flat(0, 0), 0);
  EXPECT_EQ(verdict->word, "fail");
  EXPECT_NE(verdict->reason.find("where no light can be"), std::string::npos);
}

TEST(Expectation, BlackImagesCanBeUnseen) {
  Expectation expect = against(Against::reference);
  EXPECT_EQ(judge(expect, flat(0, 0), flat(1), 0)->word, "fail");
  expect.black = BlackImage::unseen;
  const auto verdict = judge(expect, flat(0, 0), flat(1), 0);
  EXPECT_EQ(verdict->word, "unseen");
  EXPECT_EQ(verdict->reason, "");
  EXPECT_EQ(judge(expect, flat(0, 0), flat(1), 1)->word, "fail");
  EXPECT_EQ(judge(expect, flat(0, 0), flat(0, 0), 0)->word, "fail");  // the light is lost in both
}

TEST(Expectation, WhatIsNotFiniteFails) {
  EXPECT_EQ(judge(against(Against::reference), flat(1), flat(1), 1)->reason, "1 samples were not finite");
  RadianceImage image = flat(1);
  image.mean[0].r = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(judge(against(Against::reference), image, flat(1), 0)->word, "fail");
}

TEST(Expectation, ImagesSmallerThanTheBlocksAreJudgedAsWell) {
  RadianceImage image{1, 2, 4, {glm::dvec3(1), glm::dvec3(1)}, {glm::dvec3(0), glm::dvec3(0)}};
  EXPECT_EQ(judge(against(Against::reference), image, image, 0)->word, "pass");
}

}  // namespace
}  // namespace qtrace::experiments
