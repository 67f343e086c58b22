// OpenEXR files as named planes of 32-bit floats, with ZIP compression and text metadata.
#pragma once

#include "engine/core/image.h"

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace qtrace::experiments {

using ExrMetadata = std::map<std::string, std::string>;

struct ExrImage {
  int width = 0;
  int height = 0;
  std::map<std::string, std::vector<float>> channels;  // by name; each width * height values, top row first
  ExrMetadata metadata;
};

// Writes the file as it is, neither whole nor safe. Throws std::exception.
void write_exr_planes(const std::filesystem::path& file, const ExrImage& image);

// Replaces the file whole or not at all. Throws Error that names it.
void write_exr(const std::filesystem::path& file, const ExrImage& image);

// Reads all channels of 16 or 32-bit floats and all text attributes. Throws Error that names the file:
// missing, not EXR, truncated, subsampled channels, more than 65,536 pixels wide or high.
ExrImage read_exr(const std::filesystem::path& file);

// R, G, B: the mean; variance.R, .G, .B: its variance; metadata "spp".
ExrImage to_exr(const RadianceImage& image, ExrMetadata metadata);

// Adds filtered.R, .G, .B: the same image after a filter.
void add_filtered(ExrImage& exr, const RadianceImage& filtered);

// Adds half1.R, .G, .B and half2.R, .G, .B: the means over two halves of the samples, whose difference shows
// the noise without trust in the variance.
void add_halves(ExrImage& exr, const std::array<RadianceImage, 2>& halves);

// normal.X, .Y, .Z, position.X, .Y, .Z, albedo.R, .G, .B and emission.R, .G, .B.
ExrImage to_exr(const FirstHitImage& image, ExrMetadata metadata);

// The opposite of to_exr. Without variance channels the variance is zero and `samples` 0, i. e. unknown;
// with them `samples` is the metadata's spp, or 2 where it names none. Throws Error unless R, G, B are there.
RadianceImage to_radiance(const ExrImage& image, const std::filesystem::path& file);

}  // namespace qtrace::experiments
