// Linear Rec. 709 (sRGB's primaries, white D65), RGB of other primaries, and CIE XYZ.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace qtrace::experiments {

// Exact for sRGB's chromaticities with white (0.3127, 0.3290); FLIP uses the same fractions. In columns, as
// GLM has it: what one unit of R, of G and of B brings.
inline const glm::dmat3 kRec709ToXyz{
    {10135552 / 24577794.0, 2613072 / 12288897.0, 1425312 / 73733382.0},
    {8788810 / 24577794.0, 8788810 / 12288897.0, 8788810 / 73733382.0},
    {4435075 / 24577794.0, 887015 / 12288897.0, 70074185 / 73733382.0},
};

// Where primaries and white lie in the CIE 1931 diagram.
struct Primaries {
  glm::dvec2 red, green, blue, white;
};
inline constexpr Primaries kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};

// From RGB of these primaries, of which (1, 1, 1) is the white with Y = 1, to CIE XYZ (SMPTE RP 177-1993).
// Not finite where the primaries span no triangle.
inline glm::dmat3 rgb_to_xyz(const Primaries& primaries) {
  const auto xyz = [](const glm::dvec2& at) { return glm::dvec3(at.x, at.y, 1 - at.x - at.y) / at.y; };
  const glm::dmat3 columns(xyz(primaries.red), xyz(primaries.green), xyz(primaries.blue));
  const glm::dvec3 scale = glm::inverse(columns) * xyz(primaries.white);
  return {columns[0] * scale.r, columns[1] * scale.g, columns[2] * scale.b};
}

// Rec. 709, rounded to four digits.
inline double luminance(const glm::dvec3& rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

}  // namespace qtrace::experiments
