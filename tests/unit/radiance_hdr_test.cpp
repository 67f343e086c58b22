// Radiance's pictures: what the bytes mean, and which bytes are refused.
#include "experiments/images/radiance_hdr.h"
#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace qtrace::experiments {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

std::string header(const std::string& size, const std::string& variables = "FORMAT=32-bit_rle_rgbe\n") {
  return "#?RADIANCE\n" + variables + "\n" + size + "\n";
}

std::string text_of(const std::vector<Rgbe>& pixels) {
  std::string text;
  for (const Rgbe& pixel : pixels)
    for (const std::uint8_t byte : pixel) text += static_cast<char>(byte);
  return text;
}

std::vector<glm::vec3> pixels_of(const std::string& bytes) {
  return read_hdr_pixels(bytes, read_hdr_header(bytes));
}

std::string refusal_of(const std::string& bytes) {
  try {
    pixels_of(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// A row of the newer kind: runs where a byte repeats, bytes as they are where not.
std::string component_runs(const std::vector<Rgbe>& row) {
  const auto byte = [](std::size_t value) { return static_cast<char>(static_cast<std::uint8_t>(value)); };
  std::string text{byte(2), byte(2), byte(row.size() >> 8U), byte(row.size() & 255U)};
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < row.size();) {
      std::size_t end = i + 1;
      while (end < row.size() && end - i < 127 && row[end][c] == row[i][c]) ++end;
      text += end - i > 1 ? byte(128 + (end - i)) : byte(1);
      text += byte(row[i][c]);
      i = end;
    }
  }
  return text;
}

// Ward 1991: v = m / 256 * 2^(e - 128), and e = 0 is black.
TEST(RadianceHdr, AMantissaTimesAPowerOfTwo) {
  EXPECT_EQ(rgbe_radiance({128, 64, 0, 129}), glm::dvec3(1, 0.5, 0));
  EXPECT_EQ(rgbe_radiance({255, 1, 128, 128 + 8}), glm::dvec3(255, 1, 128));
  EXPECT_EQ(rgbe_radiance({128, 128, 128, 255}), glm::dvec3(std::ldexp(1.0, 126)));
  EXPECT_EQ(rgbe_radiance({255, 255, 255, 0}), glm::dvec3(0));
}

TEST(RadianceHdr, PlainPixelsGoInRowsFromTheTop) {
  const std::vector<Rgbe> pixels{{1, 2, 3, 136}, {4, 5, 6, 136}, {7, 8, 9, 136},
                                 {2, 2, 0, 136}, {1, 1, 2, 136}, {0, 0, 0, 0}};
  const std::string bytes = header("-Y 2 +X 3") + text_of(pixels);
  const HdrHeader size = read_hdr_header(bytes);
  EXPECT_EQ(size.width, 3U);
  EXPECT_EQ(size.height, 2U);
  const std::vector<glm::vec3> read = pixels_of(bytes);
  ASSERT_EQ(read.size(), 6U);
  EXPECT_EQ(read[0], glm::vec3(1, 2, 3));
  EXPECT_EQ(read[3], glm::vec3(2, 2, 0));
  EXPECT_EQ(read[5], glm::vec3(0));
}

// Wide enough for the newer runs, and yet without them; the second row begins as such a row would but for one
// bit.
TEST(RadianceHdr, WideRowsMayBePlainAsWell) {
  std::vector<Rgbe> pixels(16, {5, 6, 7, 136});
  pixels[8] = {2, 2, 200, 136};
  const std::vector<glm::vec3> read = pixels_of(header("-Y 2 +X 8") + text_of(pixels));
  EXPECT_EQ(read[8], glm::vec3(2, 2, 200));
  EXPECT_EQ(read[15], glm::vec3(5, 6, 7));
}

TEST(RadianceHdr, OlderRunsRepeatThePixelBefore) {
  // 3 copies; then 1 + 256 * 1 copies, whose count comes from its lowest byte up.
  const std::vector<Rgbe> row{{9, 8, 7, 136}, {1, 1, 1, 3}, {3, 4, 5, 136},
                              {1, 1, 1, 1},   {1, 1, 1, 1}, {0, 0, 9, 136}};
  const std::vector<glm::vec3> read = pixels_of(header("-Y 1 +X 263") + text_of(row));
  ASSERT_EQ(read.size(), 263U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(read[i], glm::vec3(9, 8, 7)) << i;
  for (std::size_t i = 4; i < 262; ++i) EXPECT_EQ(read[i], glm::vec3(3, 4, 5)) << i;
  EXPECT_EQ(read[262], glm::vec3(0, 0, 9));
}

TEST(RadianceHdr, NewerRunsGoByComponent) {
  for (const std::size_t width : {8U, 127U, 128U, 129U, 1000U}) {
    std::mt19937 random(7);
    std::vector<Rgbe> pixels(2 * width);
    for (Rgbe& pixel : pixels)
      for (std::uint8_t& byte : pixel)
        byte = random() % 4 == 0 ? std::uint8_t{140} : static_cast<std::uint8_t>(random() % 256);
    for (std::size_t i = width / 2; i < width; ++i) pixels[i] = {1, 2, 3, 130};  // runs as long as there are
    std::string bytes = header(fmt::format("-Y 2 +X {}", width));
    const auto middle = pixels.begin() + static_cast<std::ptrdiff_t>(width);
    bytes += component_runs({pixels.begin(), middle}) + component_runs({middle, pixels.end()});
    const std::vector<glm::vec3> read = pixels_of(bytes);
    ASSERT_EQ(read.size(), pixels.size());
    for (std::size_t i = 0; i < read.size(); ++i)
      EXPECT_EQ(read[i], glm::vec3(rgbe_radiance(pixels[i]))) << i;
  }
}

TEST(RadianceHdr, ExposureIsTakenOut) {
  const std::string pixel = text_of({{8, 16, 32, 136}});
  EXPECT_EQ(pixels_of(header("-Y 1 +X 1", "EXPOSURE=2\nEXPOSURE= 4.0\n") + pixel)[0], glm::vec3(1, 2, 4));
  EXPECT_EQ(pixels_of(header("-Y 1 +X 1", "COLORCORR= 1 2 4\n# EXPOSURE=9\nSOFTWARE=x\n") + pixel)[0],
            glm::vec3(8));
  EXPECT_EQ(pixels_of("#?RGBE\r\nGAMMA=1\r\n\r\n-Y 1 +X 1\r\n" + pixel)[0], glm::vec3(8, 16, 32));
}

TEST(RadianceHdr, WhatIsNotReadIsSaid) {
  const std::string pixel = text_of({{8, 16, 32, 136}});
  const auto expect = [](const std::string& bytes, const std::string& words) {
    const std::string refusal = refusal_of(bytes);
    EXPECT_NE(refusal.find(words), std::string::npos) << refusal;
  };
  expect(header("-Y 1 +X 1", "FORMAT=32-bit_rle_xyze\n") + pixel, "says 'FORMAT=32-bit_rle_xyze', but only");
  expect(header("+Y 1 +X 1") + pixel, "size is given as '+Y 1 +X 1', but only '-Y height +X width'");
  expect(header("-Y 0 +X 1") + pixel, "'-Y 0 +X 1'");
  expect(header("-Y 1 +X 4294967296") + pixel, "'-Y 1 +X 4294967296'");
  expect(header("-Y 1 +X 1x") + pixel, "'-Y 1 +X 1x'");
  for (const char* number : {"0", "-1", "x", "", "nan", "inf"})
    expect(header("-Y 1 +X 1", fmt::format("EXPOSURE={}\n", number)) + pixel,
           "must be followed by positive numbers");
  expect(header("-Y 1 +X 1", "COLORCORR=1 2\n") + pixel, "'COLORCORR=' must be followed by positive numbers");
  expect("P6\n\n-Y 1 +X 1\n", "first line must begin with #?");
  expect("#?RADIANCE\n", "ends within its header");
  expect(header("-Y 2 +X 1") + pixel, "row 1 of 2 is damaged: the file ends there");
  expect(header("-Y 1 +X 2") + text_of({{1, 1, 1, 1}, {8, 8, 8, 136}}),
         "begins with a run of a pixel that is not there");
  expect(header("-Y 1 +X 2") + text_of({{8, 8, 8, 136}, {1, 1, 1, 2}}),
         "a run of 2 pixels does not end in it");
  const std::string row = component_runs(std::vector<Rgbe>(8, {8, 8, 8, 136}));
  expect(header("-Y 1 +X 9") + row, "it has 8 pixels where the header says 9");
  expect(header("-Y 1 +X 8") + row.substr(0, row.size() - 1), "the file ends there");
  expect(header("-Y 1 +X 8") + row.substr(0, 4) + '\x89' + row.substr(5),
         "a run of 9 bytes does not end in it");
  expect(header("-Y 1 +X 8") + row.substr(0, 4) + std::string(1, '\0') + row.substr(5), "a run of 0 bytes");
}

// Damage makes an error or other pixels, as many as the header says; it never makes anything else.
TEST(RadianceHdr, AnyDamageIsAnErrorOrAnotherPicture) {
  std::mt19937 random(3);
  std::vector<Rgbe> row(20, {8, 8, 8, 136});
  for (std::size_t i = 7; i < 15; ++i) row[i] = {static_cast<std::uint8_t>(i), 3, 1, 140};
  const std::string runs = header("-Y 2 +X 20") + component_runs(row) + component_runs(row);
  const std::string older =
      header("-Y 1 +X 6") + text_of({{9, 8, 7, 136}, {1, 1, 1, 3}, {2, 2, 1, 4}, {1, 1, 1, 1}});
  int errors = 0;
  for (const std::string& good : {runs, older}) {
    const std::size_t size_ends = good.find('\n', good.find("+X"));
    ASSERT_EQ(refusal_of(good), "no error");
    for (std::size_t size = 0; size < good.size(); ++size)
      EXPECT_NE(refusal_of(good.substr(0, size)), "no error");
    for (int trial = 0; trial < 20'000; ++trial) {
      std::string bad = good;
      for (int i = 0; i < 3; ++i)
        bad[size_ends + random() % (bad.size() - size_ends)] = static_cast<char>(random() % 256);
      errors += refusal_of(bad) == "no error" ? 0 : 1;
    }
  }
  EXPECT_GT(errors, 4000);
}

}  // namespace
}  // namespace qtrace::experiments
