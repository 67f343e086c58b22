// An image out of any OpenEXR file: half or float, scan lines or tiles, one part or several (exr_layers.h).
#pragma once

#include "engine/core/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::experiments {

// Pixel coordinates of a file, both ends inclusive.
struct PixelBox {
  int left = 0;
  int top = 0;
  int right = -1;
  int bottom = -1;

  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
  bool operator==(const PixelBox&) const = default;
};

struct Picture {
  RadianceImage image;   // the pixels of `data`; variance and samples as to_radiance has them
  PixelBox data;         // the file's data window: pixels that it holds
  PixelBox display;      // and its display window: the whole frame
  std::string layer;     // the name of the layer that was read
  std::string channels;  // for the reader: "R, G, B"
};

// Throws Error that names the file and what is in it: unreadable, no such layer, several that fit.
Picture read_picture(const std::filesystem::path& file, const std::string& layer = "");

// Where the pixels of what read_picture() would read are, and the whole frame. Throws Error as it does.
struct PictureFrame {
  PixelBox data;
  PixelBox display;
};
PictureFrame read_frame(const std::filesystem::path& file, const std::string& layer = "");

// Whether the file has such a layer, or several. Throws Error where it is unreadable.
bool has_layer(const std::filesystem::path& file, const std::string& layer);

// The part of the picture within `box`, which must lie within its data window.
RadianceImage crop(const Picture& picture, const PixelBox& box);

}  // namespace qtrace::experiments
