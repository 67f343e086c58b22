#include "experiments/images/environment_file.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr_picture.h"
#include "experiments/images/radiance_hdr.h"

#include <ImfTestFile.h>

#include <cmath>
#include <fstream>
#include <string>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

bool is_hdr_file(const fs::path& file) {
  std::string start(kHdrMagic.size(), '\0');
  std::ifstream(file, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == kHdrMagic;
}

// Before memory is asked for.
void check_size(const fs::path& file, std::uint64_t width, std::uint64_t height) {
  check(
      width >= 2 && height >= 1,
      "{}: has {}x{} texels but must be at least 2 wide and 1 high: latitude and longitude of all directions",
      file.string(), width, height);
  check(width <= kMostEnvironmentTexels && height <= kMostEnvironmentTexels / width,
        "{}: has {}x{} texels, but an environment may have {} at most; shrink it, to 8192x4096 for one",
        file.string(), width, height, kMostEnvironmentTexels);
}

EnvironmentMap read_exr_environment(const fs::path& file) {
  const PictureFrame frame = read_frame(file);
  check(frame.data == frame.display,
        "{}: holds a part of its frame alone (pixels {} {} to {} {} of {} {} to {} {}), but an environment "
        "must be whole",
        file.string(), frame.data.left, frame.data.top, frame.data.right, frame.data.bottom,
        frame.display.left, frame.display.top, frame.display.right, frame.display.bottom);
  const auto width = static_cast<std::uint32_t>(frame.data.width());
  const auto height = static_cast<std::uint32_t>(frame.data.height());
  check_size(file, width, height);
  const Picture picture = read_picture(file);
  return {width, height, {picture.image.mean.begin(), picture.image.mean.end()}};
}

EnvironmentMap read_hdr_environment(const fs::path& file) {
  const std::string bytes = read_file(file);
  HdrHeader header;
  try {
    header = read_hdr_header(bytes);
  } catch (const Error& error) {
    fail("{}: cannot be read as a Radiance picture: {}", file.string(), error.what());
  }
  check_size(file, header.width, header.height);
  try {
    return {header.width, header.height, read_hdr_pixels(bytes, header)};
  } catch (const Error& error) {
    fail("{}: cannot be read as a Radiance picture: {}", file.string(), error.what());
  }
}

bool is_radiance(const glm::vec3& value) {
  bool fits = true;
  for (int c = 0; c < 3; ++c) fits = fits && std::isfinite(value[c]) && value[c] >= 0;
  return fits;
}

void check_texel(const fs::path& file, const EnvironmentMap& map, std::size_t index, const glm::vec3& value,
                 const char* what) {
  if (is_radiance(value)) return;
  fail(
      "{}: texel ({}, {}), counted from the upper left, is ({}, {}, {}){}, but radiance must be finite and "
      "not negative",
      file.string(), index % map.width, index / map.width, value.r, value.g, value.b, what);
}

void scale_texels(const fs::path& file, const glm::dvec3& scale, EnvironmentMap& map) {
  for (std::size_t i = 0; i < map.radiance.size(); ++i) {
    glm::vec3& texel = map.radiance[i];
    check_texel(file, map, i, texel, "");
    texel = glm::vec3(glm::dvec3(texel) * scale);
    check_texel(file, map, i, texel, " times its scale");
  }
}

}  // namespace

EnvironmentMap read_environment(const fs::path& file, const glm::dvec3& scale) {
  check(is_file(file), "{}: no such image; the file of key 'environment' is relative to the config file",
        file.string());
  const bool is_exr = Imf::isOpenExrFile(file.c_str());
  check(is_exr || is_hdr_file(file), "{}: is neither an OpenEXR image nor a Radiance picture (.hdr)",
        file.string());
  EnvironmentMap map = is_exr ? read_exr_environment(file) : read_hdr_environment(file);
  scale_texels(file, scale, map);
  return map;
}

}  // namespace qtrace::experiments
