// PNG and JPEG files in memory, for tests of what reads them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace qtrace {

// By the numbers of the format (PNG, third edition, 11.2.1).
enum class PngColor { grey = 0, rgb = 2, palette = 3, grey_alpha = 4, rgba = 6 };

struct PngFile {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  PngColor color = PngColor::rgb;
  int depth = 8;
  bool is_interlaced = false;
  std::string palette{};                                      // three bytes a colour
  std::string palette_alpha{};                                // tRNS
  std::optional<std::array<std::uint16_t, 3>> transparent{};  // tRNS of grey and RGB
  double gamma = 0;                                           // gAMA; 0: none
};
// `samples`: rows as the format packs them, of 16 bits the more significant byte first.
std::string png(const PngFile& file, std::string samples);

struct JpegFile {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  int components = 3;  // 1: grey, 3: RGB, 4: CMYK
  bool is_progressive = false;
};
std::string jpeg(const JpegFile& file, std::string samples);

// An RGBA PNG of one colour.
std::string png_of(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a = 255);

}  // namespace qtrace
