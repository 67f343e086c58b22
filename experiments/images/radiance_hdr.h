// Radiance's picture format (.hdr, .pic): RGB with a common exponent, four bytes a pixel, plain or run-length
// encoded. G. Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's own documents, "picture file format".
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace qtrace::experiments {

struct HdrHeader {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  glm::dvec3 exposure{1};  // what radiance has been multiplied with: EXPOSURE and COLORCORR
  std::size_t size = 0;    // bytes before the pixels
};

constexpr std::string_view kHdrMagic = "#?";

// Throws Error that says what is wrong: no such header, XYZ, rows that do not go from the top and from the
// left.
HdrHeader read_hdr_header(std::string_view bytes);

// Linear RGB, row 0 at the top: with the exposure taken out, and with primaries as they are. The header's
// size is taken for true as far as memory for a row goes. Throws Error: the rows end before the picture does,
// or a run goes on beyond its row.
std::vector<glm::vec3> read_hdr_pixels(std::string_view bytes, const HdrHeader& header);

// Mantissas of 8 bits, and an exponent with a bias of 128: zero stays zero, as in other programs' readers,
// while Radiance itself adds half of a step.
glm::dvec3 rgbe_radiance(const std::array<std::uint8_t, 4>& rgbe);

}  // namespace qtrace::experiments
