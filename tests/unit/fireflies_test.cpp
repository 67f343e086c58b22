// What is a firefly beside a reference, and what a run says of its own.
#include "experiments/records/fireflies.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtrace::experiments {
namespace {

// Brightness 1, 3, 0 and 0: 1 on average.
RadianceImage reference() {
  return {4, 1, 2, {glm::dvec3(0, 1, 2), glm::dvec3(3), glm::dvec3(0), glm::dvec3(0)}, {}};
}

TEST(Fireflies, ThresholdsAreMultiplesOfTheReferenceWithAFloor) {
  EXPECT_EQ(firefly_thresholds(reference(), 100), (std::vector<float>{100, 300, 1, 1}));
  const RadianceImage bright{1, 1, 2, {glm::dvec3(1e35)}, {}};
  EXPECT_EQ(firefly_thresholds(bright, 1e9), std::vector<float>{std::numeric_limits<float>::max()});
}

TEST(Fireflies, EnergyIsAPartOfAllRadianceBeforeClamping) {
  Outliers outliers;
  outliers.firefly_sum = 3;
  outliers.clamped_away = 2;
  outliers.brightest = {{1, 0, 7, 2.5}, {0, 0, 2, 0.5}};
  const FireflyRecord record = firefly_record(outliers, reference());  // 2 samples x 4 pixels x 1
  EXPECT_DOUBLE_EQ(*record.energy_fraction, 3.0 / (8 + 2));
  EXPECT_EQ(record.brightest, 2.5);
  EXPECT_DOUBLE_EQ(clamp_bias(outliers, reference()), -2.0 / 8);
}

TEST(Fireflies, ABlackImageHasNoneAndNoShareOfThem) {
  const RadianceImage black{1, 1, 2, {glm::dvec3(0)}, {}};
  const FireflyRecord record = firefly_record({}, black);
  EXPECT_FALSE(record.energy_fraction.has_value());
  EXPECT_FALSE(record.brightest.has_value());
  EXPECT_FALSE(std::signbit(clamp_bias({}, black)));
}

TEST(Fireflies, TheBrightest64AreListedAsMultiples) {
  Outliers outliers;
  for (std::uint32_t i = 0; i < 70; ++i) outliers.brightest.push_back({i % 4, 0, i + 1, 900.0 - i});
  const Json list = brightest_fireflies(outliers, reference());
  ASSERT_EQ(list.size(), 64U);
  EXPECT_EQ(list[1].dump(), R"({"x":1,"y":0,"frame":2,"radiance":899.0,"multiple":299.6666666666667})");
  EXPECT_EQ(list[2].at("multiple"), 898 / 0.01);
}

}  // namespace
}  // namespace qtrace::experiments
