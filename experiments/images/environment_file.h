// Images of the light that comes from outside of a scene: OpenEXR or Radiance's pictures, in latitude and
// longitude.
#pragma once

#include "engine/scene/lights.h"

#include <cstdint>
#include <filesystem>

namespace qtrace::experiments {

constexpr std::uint64_t kMostEnvironmentTexels = std::uint64_t{1} << 25U;

// The image's radiance times `scale`, which is not negative, as linear Rec. 709 where an OpenEXR file names
// its primaries. Throws Error that names the file: missing, neither format, less than 2 texels wide, too
// large, a part of its frame alone, or the first texel whose radiance is negative or not finite.
EnvironmentMap read_environment(const std::filesystem::path& file, const glm::dvec3& scale = glm::dvec3(1));

}  // namespace qtrace::experiments
