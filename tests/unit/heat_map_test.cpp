// Heat maps: which error has which colour, and files that read back.
#include "experiments/measure/heat_map.h"
#include "engine/core/check.h"
#include "experiments/images/exr.h"
#include "tests/system/temp_folder.h"

#include <png.h>

#include <gtest/gtest.h>

#include <limits>

namespace qtrace::experiments {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

// The colour of one pixel as one number.
std::uint32_t colour(const std::vector<std::uint8_t>& pixels, std::size_t i) {
  return static_cast<std::uint32_t>(pixels[3 * i]) << 16 |
         static_cast<std::uint32_t>(pixels[3 * i + 1]) << 8 | pixels[3 * i + 2];
}

TEST(HeatMap, ScalesEndAtTheNinetyNinthPercentile) {
  std::vector<double> errors(101);
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] = static_cast<double>(i);
  errors.push_back(kNan);
  const HeatScale scale = heat_scale(HeatScaling::logarithmic, errors);
  EXPECT_EQ(scale.top, 99);
  EXPECT_EQ(scale.bottom, 99e-4);  // four decades
  EXPECT_EQ(heat_scale(HeatScaling::linear, errors).bottom, 0);
  EXPECT_EQ(scale.above, 1U);
  EXPECT_EQ(scale.not_finite, 1U);
  EXPECT_EQ(heat_scale(HeatScaling::logarithmic, errors, 50).top, 50);
  EXPECT_EQ(heat_scale(HeatScaling::logarithmic, errors, 50).above, 50U);
  EXPECT_EQ(heat_scale(HeatScaling::to_one, {0.1, 0.2}).top, 1);
  errors.assign(1000, 0);
  errors[5] = 7;
  EXPECT_EQ(heat_scale(HeatScaling::logarithmic, errors).top, 7);
  EXPECT_EQ(heat_scale(HeatScaling::logarithmic, {0, 0}).top, 1);
}

TEST(HeatMap, ColoursRunFromBlackToPaleYellow) {
  const std::vector<std::uint8_t> pixels = heat_colours({0, 1, 2, 9, kNan}, HeatScale{0, 2, 1, 1});
  EXPECT_EQ(colour(pixels, 0), 0x000004U);  // magma's ends and middle, as matplotlib has them
  EXPECT_EQ(colour(pixels, 1), 0xb73779U);
  EXPECT_EQ(colour(pixels, 2), 0xfcfdbfU);
  EXPECT_EQ(colour(pixels, 3), 0xfcfdbfU);
  EXPECT_EQ(colour(pixels, 4), 0x00ff00U);
}

TEST(HeatMap, SquaredErrorsAreLogarithmic) {
  // 1e-2 to 1e2: 1 is the middle, 10 three quarters: entries round(127.5) = 128 and round(191.25) = 191.
  const std::vector<std::uint8_t> pixels =
      heat_colours({0, 1e-2, 1, 10, 1e2, 1e3}, HeatScale{1e-2, 1e2, 1, 0});
  EXPECT_EQ(colour(pixels, 0), 0x000004U);
  EXPECT_EQ(colour(pixels, 1), 0x000004U);
  EXPECT_EQ(colour(pixels, 2), 0xb73779U);
  EXPECT_EQ(colour(pixels, 3), 0xfb8761U);
  EXPECT_EQ(colour(pixels, 4), 0xfcfdbfU);
  EXPECT_EQ(colour(pixels, 5), 0xfcfdbfU);
}

TEST(HeatMap, PngHasItsPixelsInPlace) {
  const tests::TempFolder folder;
  const std::vector<double> errors{0, 1, 2, 2, 0, 1};  // 3x2
  write_heat_map(folder / "heat.png", error_metric("mse"), 3, 2, errors, HeatScale{0, 2, 0, 0});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, (folder / "heat.png").c_str()), 0);
  EXPECT_EQ(image.width, 3U);
  EXPECT_EQ(image.height, 2U);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels, heat_colours(errors, HeatScale{0, 2, 0, 0}));
}

TEST(HeatMap, ExrHasTheValues) {
  const tests::TempFolder folder;
  write_heat_map(folder / "heat.exr", error_metric("smape"), 2, 1, {0.25, 1e6}, HeatScale{0, 0.5, 1, 0});
  const ExrImage exr = read_exr(folder / "heat.exr");
  EXPECT_EQ(exr.channels.at("Y"), (std::vector<float>{0.25F, 1e6F}));
  EXPECT_EQ(exr.metadata.at("metric"), "smape");
  EXPECT_EQ(exr.metadata.at("heatBottom"), "0");
  EXPECT_EQ(exr.metadata.at("heatTop"), "0.5");
}

TEST(HeatMap, FailuresNameTheFileAndLeaveWhatIsThere) {
  const tests::TempFolder folder;
  EXPECT_THROW(check_heat_file("heat.jpg"), Error);
  try {
    write_heat_map(folder / "none/heat.png", error_metric("mse"), 1, 1, {0}, HeatScale{});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("none/heat.png: cannot be written"), std::string::npos);
  }
}

TEST(HeatMap, EveryMetricMapsItsPixels) {
  // The mean of a map is the metric.
  RadianceImage image{2, 1, 0, {{1, 2, 3}, {0, 0, 1}}, {}}, reference{2, 1, 0, {{1, 1, 0}, {4, 0, 0}}, {}};
  EXPECT_EQ(error_metric("mse").map(image, reference), (std::vector<double>{10.0 / 3, 17.0 / 3}));
  const std::vector<double> smape = error_metric("smape").map(image, reference);
  EXPECT_DOUBLE_EQ(smape[1], (4 / 4.01 + 0 + 1 / 1.01) / 3);
  image.mean[0].x = kNan;
  EXPECT_TRUE(std::isnan(error_metric("mape").map(image, reference)[0]));
}

}  // namespace
}  // namespace qtrace::experiments
