// OpenEXR files as named planes of 32-bit floats, with ZIP compression and text metadata.
#pragma once

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

}  // namespace qtrace::experiments
