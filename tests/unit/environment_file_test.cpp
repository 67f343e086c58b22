// Images around a scene: which files are read as what, and which are refused.
#include "experiments/images/environment_file.h"
#include "engine/core/check.h"
#include "experiments/images/exr.h"
#include "tests/support/exr_files.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <limits>
#include <numbers>

namespace qtrace::experiments {
namespace {

using tests::TestChannel;

class EnvironmentFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::vector<TestChannel>& channels,
                              const Imath::Box2i& data = {{0, 0}, {3, 1}},
                              const Imath::Box2i& display = {{0, 0}, {3, 1}}) const {
    tests::write_scan_lines(file_, {channels, "", data, display});
    return file_;
  }

  void expect_refusal(const std::string& words, const glm::dvec3& scale = glm::dvec3(1)) const {
    try {
      read_environment(file_, scale);
      ADD_FAILURE() << "no error where this was expected: " << words;
    } catch (const Error& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.starts_with(file_.string() + ": ")) << text;
      EXPECT_NE(text.find(words), std::string::npos) << text;
    }
  }

  tests::TempFolder folder_;
  std::filesystem::path file_ = folder_ / "sky.exr";
};

// The channels' texel (x, y) has its value + 10 x + 100 y.
TEST_F(EnvironmentFile, OpenExrInHalfAndFloatWithAndWithoutOpacity) {
  for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
    const EnvironmentMap map =
        read_environment(write({{"R", 1, type}, {"G", 2, type}, {"B", 3, type}, {"A", 9, type}}));
    EXPECT_EQ(map.width, 4U);
    EXPECT_EQ(map.height, 2U);
    ASSERT_EQ(map.radiance.size(), 8U);
    EXPECT_EQ(map.radiance[0], glm::vec3(1, 2, 3)) << "the upper left";
    EXPECT_EQ(map.radiance[6], glm::vec3(121, 122, 123)) << "column 2, row 1";
    EXPECT_EQ(map.rotation, 0);
  }
}

TEST_F(EnvironmentFile, LuminanceAloneIsGrey) {
  EXPECT_EQ(read_environment(write({{"Y", 4}})).radiance[1], glm::vec3(14));
}

TEST_F(EnvironmentFile, RadiancePicturesByTheirFirstBytes) {
  file_ =
      folder_.write("sky.exr", std::string("#?RADIANCE\n\n-Y 1 +X 2\n\x08\x10\x20\x88\x01\x02\x03\x88", 30));
  const EnvironmentMap map = read_environment(file_);
  EXPECT_EQ(map.width, 2U);
  EXPECT_EQ(map.height, 1U);
  EXPECT_EQ(map.radiance, (std::vector<glm::vec3>{{8, 16, 32}, {1, 2, 3}}));
}

TEST_F(EnvironmentFile, ScaleMultipliesRadiance) {
  write({{"R", 1}, {"G", 2}, {"B", 3}});
  EXPECT_EQ(read_environment(file_, {2, 0.5, 0}).radiance[1], glm::vec3(22, 6, 0));
}

// As configs/scenes/sky.py makes it: 25 degrees high, 110 degrees from -z towards -x, and this bright.
TEST_F(EnvironmentFile, TheShippedSkyHasItsSunWhereItIsSaid) {
  const EnvironmentMap sky = read_environment(QTRACE_SOURCE_DIR "/configs/scenes/sunlit_sky.hdr");
  ASSERT_EQ(sky.width, 2 * sky.height);
  glm::dvec3 direction(0);
  glm::dvec3 irradiance(0);
  for (std::uint32_t y = 0; y < sky.height; ++y) {
    for (std::uint32_t x = 0; x < sky.width; ++x) {
      const glm::dvec3 radiance(sky.radiance[std::size_t{y} * sky.width + x]);
      if (radiance.r < 20) continue;
      const double polar = (y + 0.5) / sky.height * std::numbers::pi;
      const double turn = ((x + 0.5) / sky.width - 0.5) * 2 * std::numbers::pi;
      const double solid_angle = std::sin(polar) * 2 * std::pow(std::numbers::pi, 2) / sky.width / sky.height;
      irradiance += radiance * solid_angle;
      direction +=
          radiance.r * solid_angle *
          glm::dvec3(std::sin(polar) * std::sin(turn), std::cos(polar), -std::sin(polar) * std::cos(turn));
    }
  }
  direction = glm::normalize(direction);
  EXPECT_NEAR(glm::degrees(std::asin(direction.y)), 25, 0.05);
  EXPECT_NEAR(glm::degrees(std::atan2(-direction.x, -direction.z)), 110, 0.05);
  const glm::dvec3 sun(21, 18.5, 14.5);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c] / sun[c], 1, 0.01);
}

TEST_F(EnvironmentFile, WhatIsNoImageIsRefused) {
  file_ = folder_ / "none.exr";
  expect_refusal("no such image; the file of key 'environment' is relative to the config file");
  file_ = folder_.path();
  expect_refusal("no such image");
  file_ = folder_.write("sky.png", "\x89PNG\r\n");
  expect_refusal("is neither an OpenEXR image nor a Radiance picture (.hdr)");
  file_ = folder_.write("empty.hdr", "");
  expect_refusal("is neither");
  file_ = folder_.write("cut.hdr", "#?RADIANCE\n\n-Y 2 +X 4\n");
  expect_refusal("cannot be read as a Radiance picture: its row 0 of 2 is damaged");
  file_ = folder_ / "sky.exr";
  write({{"R", 1}, {"G", 2}, {"B", 3}});
  folder_.write("sky.exr", folder_.read("sky.exr").substr(0, 200));
  expect_refusal("OpenEXR image");
  write({{"Z", 1}});
  expect_refusal("has no channels R, G, B");
}

TEST_F(EnvironmentFile, SizesThatAreNoSkyAreRefused) {
  write({{"Y", 1}}, {{0, 0}, {0, 3}}, {{0, 0}, {0, 3}});
  expect_refusal("has 1x4 texels but must be at least 2 wide and 1 high");
  write({{"Y", 1}}, {{1, 0}, {3, 1}});
  expect_refusal("holds a part of its frame alone (pixels 1 0 to 3 1 of 0 0 to 3 1)");
  file_ = folder_.write("large.hdr", "#?RADIANCE\n\n-Y 4097 +X 8192\n");
  expect_refusal("has 8192x4097 texels, but an environment may have 33554432 at most; shrink it");
  file_ = folder_.write("huge.hdr", "#?RADIANCE\n\n-Y 4294967295 +X 4294967295\n");
  expect_refusal("has 4294967295x4294967295 texels");
  // As many as may be: the next thing to be missed is the first row.
  file_ = folder_.write("largest.hdr", "#?RADIANCE\n\n-Y 4096 +X 8192\n");
  expect_refusal("row 0 of 4096 is damaged");
}

TEST_F(EnvironmentFile, TheFirstTexelThatIsNoRadianceIsNamed) {
  write({{"R", 200}, {"G", -120.5}, {"B", 3}});
  expect_refusal(
      "texel (0, 0), counted from the upper left, is (200, -120.5, 3), but radiance must be finite and not "
      "negative");
  ExrImage image{2, 2, {{"R", {1, 1, 1, -2}}, {"G", {1, 1, 1, 1}}, {"B", {1, 1, -1, 1}}}, {}};
  write_exr(file_, image);
  expect_refusal("texel (0, 1), counted from the upper left, is (1, 1, -1), but");
  image.channels["B"][2] = 0;
  write_exr(file_, image);
  expect_refusal("texel (1, 1), counted from the upper left, is (-2, 1, 1), but");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    write({{"R", 1}, {"G", 2}, {"B", bad}});
    expect_refusal("texel (0, 0), counted from the upper left, is (1, 2, ");
  }
  // An exponent of 255 and the largest exposure that a picture can say overflow a float, in the second row
  // alone.
  file_ =
      folder_.write("row.hdr", std::string("#?RADIANCE\nEXPOSURE=1e-10\n\n-Y 2 +X 2\n"
                                           "\x08\x08\x08\x88\x08\x08\x08\x88\x08\x08\x08\x88\x08\x08\x08\xff",
                                           53));
  expect_refusal("texel (1, 1), counted from the upper left, is (inf, inf, inf)");
}

TEST_F(EnvironmentFile, AScaleThatOverflowsIsNamed) {
  write({{"Y", 1e37}});
  expect_refusal("texel (0, 0), counted from the upper left, is (inf, inf, inf) times its scale",
                 glm::dvec3(1e8));
}

}  // namespace
}  // namespace qtrace::experiments
