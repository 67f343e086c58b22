#include "tests/unit/picture_files.h"

#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>
#include <png.h>

#include <vector>

namespace qtrace {
namespace {

void append(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<char*>(bytes), count);
}

void set_palette(const PngFile& file, png_structp png, png_infop info) {
  std::vector<png_color> colors(file.palette.size() / 3);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<png_byte>(file.palette[3 * i + k]); };
    colors[i] = {byte(0), byte(1), byte(2)};
  }
  png_set_PLTE(png, info, colors.data(), static_cast<int>(colors.size()));
  const auto* alpha = reinterpret_cast<const png_byte*>(file.palette_alpha.data());
  if (!file.palette_alpha.empty())
    png_set_tRNS(png, info, alpha, static_cast<int>(file.palette_alpha.size()), nullptr);
}

void set_transparent(const std::array<std::uint16_t, 3>& color, png_structp png, png_infop info) {
  png_color_16 key{};
  key.red = key.gray = color[0];
  key.green = color[1];
  key.blue = color[2];
  png_set_tRNS(png, info, nullptr, 0, &key);
}

}  // namespace

std::string png(const PngFile& file, std::string samples) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, append, nullptr);
  png_set_IHDR(png, info, file.width, file.height, file.depth, static_cast<int>(file.color),
               file.is_interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (!file.palette.empty()) set_palette(file, png, info);
  if (file.transparent) set_transparent(*file.transparent, png, info);
  if (file.gamma > 0) png_set_gAMA(png, info, file.gamma);
  png_write_info(png, info);
  const std::size_t row = png_get_rowbytes(png, info);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < file.height; ++y) {
    rows.push_back(reinterpret_cast<png_bytep>(samples.data()) + y * row);
  }
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string jpeg(const JpegFile& file, std::string samples) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = file.width;
  jpeg.image_height = file.height;
  jpeg.input_components = file.components;
  jpeg.in_color_space = file.components == 1 ? JCS_GRAYSCALE : file.components == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 100, TRUE);
  if (file.is_progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  const std::size_t row = std::size_t{file.width} * static_cast<std::size_t>(file.components);
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW first = reinterpret_cast<JSAMPROW>(samples.data()) + jpeg.next_scanline * row;
    jpeg_write_scanlines(&jpeg, &first, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::string bytes(reinterpret_cast<char*>(data), size);
  std::free(data);
  return bytes;
}

std::string png_of(std::uint8_t r, std::uint8_t g, std::uint8_t b, std::uint8_t a) {
  std::string texel;
  for (const std::uint8_t value : {r, g, b, a}) texel += static_cast<char>(value);
  return png({.color = PngColor::rgba}, texel);
}

}  // namespace qtrace
