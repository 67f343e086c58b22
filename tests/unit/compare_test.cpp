// What `qtrace compare` compares: which pixels of which layer, and where its heat map goes.
#include "experiments/commands/compare.h"
#include "engine/core/check.h"
#include "experiments/images/exr.h"
#include "tests/support/exr_files.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>

namespace qtrace::experiments {
namespace {

using tests::TestPart;

// R, G, B of `value` + 10 x + 100 y.
TestPart rgb(double value, Imath::Box2i data, Imath::Box2i display, const std::string& prefix = "") {
  return {{{prefix + "R", value}, {prefix + "G", value}, {prefix + "B", value}}, "", data, display};
}

const Imath::Box2i kFrame{{0, 0}, {3, 3}};

class Compare : public testing::Test {
 protected:
  std::string compare() const {
    try {
      return compare_files(options_);
    } catch (const Error& error) {
      return error.what();
    }
  }

  // The output has each of these.
  static void expect(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }

  tests::TempFolder folder_;
  CompareOptions options_{folder_ / "a.exr", folder_ / "r.exr"};
};

TEST_F(Compare, OneSizeOneFrame) {
  tests::write_scan_lines(options_.image, rgb(3, kFrame, kFrame));
  tests::write_scan_lines(options_.reference, rgb(1, kFrame, kFrame));
  expect(compare(), {"a.exr: channels R, G, B\n", "r.exr: channels R, G, B\n", "mse                 4 ",
                     "bias                2 ", "0 of 16 pixels"});
}

TEST_F(Compare, ACropIsComparedWhereItLies) {
  // At the same place the images differ by 2; were the crop laid into the corner, it would differ by 2 + 110.
  tests::write_scan_lines(options_.image, rgb(3, {{1, 1}, {2, 3}}, kFrame));
  tests::write_scan_lines(options_.reference, rgb(1, kFrame, kFrame));
  expect(compare(),
         {"a.exr: channels R, G, B\n", "r.exr: channels R, G, B; pixels 1 to 2 across, 1 to 3 down\n",
          "mse                 4 ", "0 of 6 pixels"});
}

TEST_F(Compare, OverscanThatOnlyOneFileHasIsLeftOut) {
  tests::write_scan_lines(options_.image, rgb(3, {{-2, -1}, {5, 4}}, kFrame));
  tests::write_scan_lines(options_.reference, rgb(1, kFrame, kFrame));
  expect(compare(), {"mse                 4 ", "0 of 16 pixels"});
}

TEST_F(Compare, WindowsThatDoNotMeetAreRefused) {
  tests::write_scan_lines(options_.image, rgb(3, {{0, 0}, {1, 1}}, kFrame));
  tests::write_scan_lines(options_.reference, rgb(1, {{2, 2}, {3, 3}}, kFrame));
  expect(compare(), {"a.exr: has pixels 0 to 1 across, 0 to 1 down, but the reference ",
                     "r.exr has pixels 2 to 3 across, 2 to 3 down: no pixel is in both"});
}

TEST_F(Compare, FramesOfOtherSizesMustHoldAsManyPixels) {
  tests::write_scan_lines(options_.image, rgb(3, kFrame, kFrame));
  tests::write_scan_lines(options_.reference, rgb(3, {{0, 0}, {2, 3}}, {{0, 0}, {2, 3}}));
  expect(compare(), {"a.exr: has 4x4 pixels, but the reference ", "has 3x4; both must have the same size"});
  // A crop that was cut out of its frame: as many pixels, and what was (1, 1) is now (0, 0).
  tests::write_scan_lines(options_.image, rgb(113, {{0, 0}, {1, 1}}, {{0, 0}, {1, 1}}));
  tests::write_scan_lines(options_.reference, rgb(1, {{1, 1}, {2, 2}}, kFrame));
  expect(compare(), {"mse                 4 ", "0 of 4 pixels"});
}

TEST_F(Compare, LayersAreChosenForEachFile) {
  TestPart image = rgb(3, kFrame, kFrame);
  for (const auto& channel : rgb(6, kFrame, kFrame, "filtered.").channels) image.channels.push_back(channel);
  tests::write_scan_lines(options_.image, image);
  tests::write_scan_lines(options_.reference, rgb(1, kFrame, kFrame));
  expect(compare(), {"mse                 4 "});
  options_.layer = "filtered";
  expect(compare(), {"r.exr: has no layer 'filtered', which ", "a.exr has; --reference-layer names the one"});
  options_.reference_layer = "<root>";
  expect(compare(), {"a.exr: channels filtered.R, filtered.G, filtered.B\n", "mse                 25 "});
  options_.reference = options_.image;
  options_.reference_layer = "";
  expect(compare(), {"mse                 0 "});
  options_.reference_layer = "<root>";
  expect(compare(), {"mse                 9 "});
  TestPart twice = rgb(1, kFrame, kFrame);
  for (const char* prefix : {"a.filtered.", "b.filtered."}) {
    for (const auto& channel : rgb(6, kFrame, kFrame, prefix).channels) twice.channels.push_back(channel);
  }
  options_.reference = folder_ / "twice.exr";
  tests::write_scan_lines(options_.reference, twice);
  options_.reference_layer = "";
  expect(compare(), {"twice.exr: has several layers 'filtered'; its layers are: <root> ("});
  options_.reference = options_.image;
  options_.reference_layer = "beauty";
  expect(compare(), {"has no layer 'beauty'; its layers are: <root> (R, G, B), filtered ("});
}

TEST_F(Compare, PixelsThatAreNotFiniteAreCountedFirst) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  tests::write_scan_lines(options_.reference, rgb(1, {{0, 0}, {1, 0}}, {{0, 0}, {1, 0}}));
  write_exr(options_.image, {2, 1, {{"R", {3, nan}}, {"G", {3, 1}}, {"B", {3, 1}}}, {}});
  expect(compare(),
         {"left out: 1 of 2 pixels, which are not finite (1 in the image, 0 in the reference)\n\n"});
  write_exr(options_.image, {2, 1, {{"R", {3, nan}}, {"G", {-infinity, 1}}, {"B", {infinity, 1}}}, {}});
  expect(compare(), {"a.exr: no pixel is finite both there (2 of 2 are not) and in the reference "});
}

TEST_F(Compare, TheHeatMapHasTheErrorOfEveryPixel) {
  tests::write_scan_lines(options_.image, {{{"Y", 1}}, "", {{0, 0}, {1, 0}}, {{0, 0}, {1, 0}}});
  tests::write_scan_lines(options_.reference, rgb(1, {{0, 0}, {1, 0}}, {{0, 0}, {1, 0}}));
  options_.heat = folder_ / "heat.exr";
  options_.heat_metric = "mse";
  expect(compare(), {"heat.exr: mse per pixel\n", "psnr_db             inf"});
  EXPECT_EQ(read_exr(options_.heat).channels.at("Y"), (std::vector<float>{0, 0}));
  tests::write_scan_lines(options_.image, {{{"Y", 4}}, "", {{0, 0}, {1, 0}}, {{0, 0}, {1, 0}}});
  compare();
  EXPECT_EQ(read_exr(options_.heat).channels.at("Y"), (std::vector<float>{9, 9}));
  options_.heat = folder_ / "heat.png";
  options_.heat_top = 3;
  expect(
      compare(),
      {"heat.png: mse per pixel, magma, logarithmic from 0.0003 (black) to 3 (pale yellow); 2 of 2 pixels"});
}

TEST_F(Compare, NothingIsWrittenWhereSomethingIsWrong) {
  tests::write_scan_lines(options_.image, rgb(3, kFrame, kFrame));
  options_.heat = folder_ / "heat.png";
  expect(compare(), {"r.exr: no such file"});
  options_.reference = options_.image;
  options_.heat = folder_ / "heat.jpg";
  expect(compare(), {"heat.jpg: a heat map is written as .png (false colours) or .exr (the values)"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "heat.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "heat.jpg"));
}

}  // namespace
}  // namespace qtrace::experiments
