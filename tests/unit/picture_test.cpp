// Pictures in files, decoded as they are.
#include "engine/picture/picture.h"
#include "engine/core/check.h"
#include "tests/unit/picture_files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace qtrace {
namespace {

using Texel = TextureImage::Texel;

picture::Bytes as_bytes(const std::string& file) {
  return {reinterpret_cast<const unsigned char*>(file.data()), file.size()};
}

TextureImage decoded(const std::string& file) { return picture::decode(as_bytes(file), "picture 'p'"); }

void expect_refusal(const std::string& file, const std::string& part) {
  try {
    decoded(file);
    ADD_FAILURE() << "accepted; refusal should say " << part;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find("picture 'p': "), 0U) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

Texel bytes_times_257(int r, int g, int b, int a) {
  Texel texel{};
  int i = 0;
  for (const int value : {r, g, b, a})
    texel[static_cast<std::size_t>(i++)] = static_cast<std::uint16_t>(257 * value);
  return texel;
}

TEST(PictureTest, RowsAreFromTheTop) {
  const TextureImage image =
      decoded(png({.width = 2, .height = 2}, std::string("\1\2\3\4\5\6\7\10\11\12\13\14")));
  EXPECT_EQ(image.width, 2U);
  EXPECT_EQ(image.height, 2U);
  EXPECT_EQ(image.texels,
            (std::vector<Texel>{bytes_times_257(1, 2, 3, 255), bytes_times_257(4, 5, 6, 255),
                                bytes_times_257(7, 8, 9, 255), bytes_times_257(10, 11, 12, 255)}));
}

TEST(PictureTest, EightBitsOfEachKindOfPng) {
  EXPECT_EQ(decoded(png({.color = PngColor::grey}, "\x80")).texels[0], bytes_times_257(128, 128, 128, 255));
  EXPECT_EQ(decoded(png({.color = PngColor::grey_alpha}, "\x80\x40")).texels[0],
            bytes_times_257(128, 128, 128, 64));
  EXPECT_EQ(decoded(png({.color = PngColor::rgb}, "\x10\x20\x30")).texels[0],
            bytes_times_257(16, 32, 48, 255));
  EXPECT_EQ(decoded(png({.color = PngColor::rgba}, "\x10\x20\x30\x40")).texels[0],
            bytes_times_257(16, 32, 48, 64));
}

TEST(PictureTest, SixteenBitsOfEachKindOfPng) {
  EXPECT_EQ(decoded(png({.color = PngColor::grey, .depth = 16}, "\x12\x34")).texels[0],
            (Texel{0x1234, 0x1234, 0x1234, 0xffff}));
  EXPECT_EQ(decoded(png({.color = PngColor::grey_alpha, .depth = 16}, "\x12\x34\x56\x78")).texels[0],
            (Texel{0x1234, 0x1234, 0x1234, 0x5678}));
  EXPECT_EQ(decoded(png({.color = PngColor::rgb, .depth = 16}, "\x12\x34\x56\x78\x9a\xbc")).texels[0],
            (Texel{0x1234, 0x5678, 0x9abc, 0xffff}));
  EXPECT_EQ(
      decoded(png({.color = PngColor::rgba, .depth = 16}, "\x12\x34\x56\x78\x9a\xbc\xde\xf0")).texels[0],
      (Texel{0x1234, 0x5678, 0x9abc, 0xdef0}));
}

TEST(PictureTest, FewBitsSpanTheWholeRange) {
  const TextureImage image =
      decoded(png({.width = 4, .color = PngColor::grey, .depth = 2}, "\x1b"));  // 0 1 2 3
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(image.texels[static_cast<std::size_t>(i)], bytes_times_257(85 * i, 85 * i, 85 * i, 255)) << i;
  }
}

TEST(PictureTest, PalettesAndTransparentColours) {
  const PngFile palette{.width = 3,
                        .color = PngColor::palette,
                        .palette = "\1\2\3\4\5\6\7\10\11",
                        .palette_alpha = std::string("\0\x80", 2)};
  EXPECT_EQ(decoded(png(palette, std::string("\2\1\0", 3))).texels,
            (std::vector<Texel>{bytes_times_257(7, 8, 9, 255), bytes_times_257(4, 5, 6, 128),
                                bytes_times_257(1, 2, 3, 0)}));
  const PngFile key{.width = 2, .transparent = {{{1, 2, 3}}}};
  EXPECT_EQ(decoded(png(key, "\1\2\3\1\2\4")).texels,
            (std::vector<Texel>{bytes_times_257(1, 2, 3, 0), bytes_times_257(1, 2, 4, 255)}));
  const PngFile grey{.width = 2, .color = PngColor::grey, .depth = 16, .transparent = {{{0x1234, 0, 0}}}};
  const TextureImage image = decoded(png(grey, "\x12\x34\x12\x35"));
  EXPECT_EQ(image.texels[0][3], 0);
  EXPECT_EQ(image.texels[1][3], 0xffff) << "the lower byte counts, too";
}

TEST(PictureTest, InterlacedPngsAreTheSame) {
  std::string samples;
  for (int i = 0; i < 13 * 11 * 3; ++i) samples += static_cast<char>(i * 7);
  const TextureImage plain = decoded(png({.width = 13, .height = 11}, samples));
  const TextureImage interlaced = decoded(png({.width = 13, .height = 11, .is_interlaced = true}, samples));
  EXPECT_EQ(plain.texels, interlaced.texels);
  EXPECT_EQ(plain.texels[14], bytes_times_257(14 * 21 & 255, (14 * 21 + 7) & 255, (14 * 21 + 14) & 255, 255));
}

TEST(PictureTest, WhatAPngSaysOfItsGammaDoesNotCount) {
  EXPECT_EQ(decoded(png({.gamma = 1.0}, "\x10\x20\x30")).texels[0], bytes_times_257(16, 32, 48, 255));
  EXPECT_EQ(decoded(png({.gamma = 0.2}, "\x10\x20\x30")).texels[0], bytes_times_257(16, 32, 48, 255));
}

// Of one colour, nothing is lost but by the rounding of YCbCr.
void expect_near(const TextureImage& image, std::uint32_t width, int r, int g, int b) {
  EXPECT_EQ(image.width, width);
  for (const Texel& texel : image.texels) {
    EXPECT_NEAR(texel[0] / 257.0, r, 2);
    EXPECT_NEAR(texel[1] / 257.0, g, 2);
    EXPECT_NEAR(texel[2] / 257.0, b, 2);
    EXPECT_EQ(texel[3], 0xffff);
    EXPECT_EQ(texel[0] % 257, 0);
  }
}

std::string repeated(const std::string& texel, int count) {
  std::string samples;
  for (int i = 0; i < count; ++i) samples += texel;
  return samples;
}

TEST(PictureTest, ReadsJpegs) {
  for (const bool is_progressive : {false, true}) {
    const JpegFile rgb{.width = 19, .height = 11, .is_progressive = is_progressive};
    expect_near(decoded(jpeg(rgb, repeated("\xc0\x60\x20", 19 * 11))), 19, 192, 96, 32);
    const JpegFile grey{.width = 19, .height = 11, .components = 1, .is_progressive = is_progressive};
    expect_near(decoded(jpeg(grey, repeated("\x50", 19 * 11))), 19, 80, 80, 80);
  }
}

TEST(PictureTest, RowsOfJpegsAreFromTheTopToo) {
  const std::string samples = repeated(std::string("\0\0\0", 3), 16 * 8) + repeated("\xff\xff\xff", 16 * 8);
  const TextureImage image = decoded(jpeg({.width = 16, .height = 16}, samples));
  EXPECT_LT(image.texels.front()[0], 257 * 10);
  EXPECT_GT(image.texels.back()[0], 257 * 245);
}

TEST(PictureTest, RefusesTheColoursOfAPrint) {
  expect_refusal(jpeg({.width = 8, .height = 8, .components = 4}, repeated("abcd", 64)),
                 "the JPEG has the colours of a print (CMYK); RGB or grey would be right");
}

// Noise, whose data goes on to the end of the file.
std::string noise(int count) {
  std::string samples;
  std::uint32_t state = 1;
  for (int i = 0; i < count; ++i)
    samples += static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  return samples;
}

TEST(PictureTest, RefusesWhatIsCutShort) {
  const std::string samples = noise(64 * 64 * 3);
  for (const std::string& file :
       {png({.width = 64, .height = 64}, samples), jpeg({.width = 64, .height = 64}, samples),
        jpeg({.width = 64, .height = 64, .is_progressive = true}, samples)}) {
    decoded(file);
    for (const double share : {0.999, 0.9, 0.5, 0.1}) {
      const auto size = static_cast<std::size_t>(share * static_cast<double>(file.size()));
      expect_refusal(file.substr(0, size), "cannot be decoded: ");
    }
    for (std::size_t size = 8; size < 200; ++size) expect_refusal(file.substr(0, size), "");
  }
}

TEST(PictureTest, RefusesDamage) {
  std::string file = png({.width = 64, .height = 64}, noise(64 * 64 * 3));
  file[file.size() / 2] ^= 1;
  expect_refusal(file, "the PNG cannot be decoded: ");
}

void set_word(std::string& file, std::size_t offset, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) file[offset + i] = static_cast<char>(value >> (24 - 8 * i));
}

// The check sum of a chunk (PNG, annex D).
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t c = 0xffffffffU;
  for (const char byte : bytes) {
    c ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) c = (c & 1U) != 0 ? 0xedb88320U ^ c >> 1U : c >> 1U;
  }
  return ~c;
}

std::string png_that_claims(std::uint32_t width, std::uint32_t height) {
  std::string file = png_of(1, 2, 3);
  set_word(file, 16, width);
  set_word(file, 20, height);
  set_word(file, 29, crc(file.substr(12, 17)));
  return file;
}

// 70 bytes that ask for gigabytes.
TEST(PictureTest, RefusesSizesBeforeThereIsMemoryForThem) {
  expect_refusal(png_that_claims(32769, 1), "it has 32769 x 1 texels; 1 to 32768 a side would be right");
  expect_refusal(png_that_claims(1, 0x7fffffff), "it has 1 x 2147483647 texels");
  expect_refusal(png_that_claims(32768, 32768),
                 "the PNG is cut short: it declares 32768 x 32768 texels and has ");
  std::string file = jpeg({}, "abc");
  const std::size_t frame = file.find("\xff\xc0");
  file.replace(frame + 5, 4, "\x90\x01\x90\x01");
  expect_refusal(file, "it has 36865 x 36865 texels");
}

TEST(PictureTest, NamesOtherKinds) {
  expect_refusal(std::string("RIFF\0\0\0\0WEBPVP8 ", 16),
                 "its bytes are image/webp; PNG or JPEG would be right");
  expect_refusal("\xabKTX 20\xbb\r\n\x1a\n", "its bytes are image/ktx2");
  expect_refusal("plain text", "its bytes are no picture that is known");
  expect_refusal("", "its bytes are no picture that is known");
}

TEST(PictureTest, TheSizeStandsInTheHeader) {
  const std::string file = png({.width = 64, .height = 32}, noise(64 * 32 * 3)).substr(0, 60);
  const picture::Size size = picture::read_size(as_bytes(file), "p");
  EXPECT_EQ(size.width, 64U);
  EXPECT_EQ(size.height, 32U);
}

}  // namespace
}  // namespace qtrace
