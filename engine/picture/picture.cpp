#include "engine/picture/picture.h"

#include "engine/core/check.h"
#include "engine/picture/jpeg.h"
#include "engine/picture/png.h"

#include <algorithm>

namespace qtrace::picture {
namespace {

constexpr std::string_view kPng = "image/png", kJpeg = "image/jpeg";

bool has_at(Bytes bytes, std::size_t offset, std::string_view wanted) {
  return bytes.size() >= offset + wanted.size() &&
         std::ranges::equal(bytes.subspan(offset, wanted.size()), wanted,
                            [](unsigned char a, char b) { return a == static_cast<unsigned char>(b); });
}

void check_is_decodable(Bytes bytes, const std::string& what) {
  const std::string_view type = media_type(bytes);
  check(type == kPng || type == kJpeg, "{}: its bytes are {}; PNG or JPEG would be right", what,
        type.empty() ? "no picture that is known" : type);
}

void check_sides(const Size& size, const std::string& what) {
  check(size.width > 0 && size.height > 0 && size.width <= kMostOfASide && size.height <= kMostOfASide,
        "{}: it has {} x {} texels; 1 to {} a side would be right", what, size.width, size.height,
        kMostOfASide);
}

}  // namespace

std::string_view media_type(Bytes bytes) {
  if (has_at(bytes, 0, "\x89PNG\r\n\x1a\n")) return kPng;
  if (has_at(bytes, 0, "\xff\xd8\xff")) return kJpeg;
  if (has_at(bytes, 0, "RIFF") && has_at(bytes, 8, "WEBP")) return "image/webp";
  if (has_at(bytes, 0, "\xabKTX 20\xbb")) return "image/ktx2";
  if (has_at(bytes, 4, "ftypavif")) return "image/avif";
  if (has_at(bytes, 0, "DDS ")) return "image/vnd-ms.dds";
  return has_at(bytes, 0, "GIF8") ? "image/gif" : "";
}

Size read_size(Bytes bytes, const std::string& what) {
  check_is_decodable(bytes, what);
  const Size size = media_type(bytes) == kPng ? read_png_size(bytes, what) : read_jpeg_size(bytes, what);
  check_sides(size, what);
  return size;
}

TextureImage decode(Bytes bytes, const std::string& what) {
  const Size size = read_size(bytes, what);
  TextureImage image;
  image.width = size.width;
  image.height = size.height;
  if (media_type(bytes) == kPng) {
    decode_png(bytes, what, image);
  } else {
    decode_jpeg(bytes, what, image);
  }
  return image;
}

}  // namespace qtrace::picture
