// Linear Rec. 709 (sRGB's primaries, white D65) and CIE XYZ.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace qtrace::experiments {

// Exact for sRGB's chromaticities with white (0.3127, 0.3290); FLIP uses the same fractions. In columns, as
// GLM has it: what one unit of R, of G and of B brings.
inline const glm::dmat3 kRec709ToXyz{
    {10135552 / 24577794.0, 2613072 / 12288897.0, 1425312 / 73733382.0},
    {8788810 / 24577794.0, 8788810 / 12288897.0, 8788810 / 73733382.0},
    {4435075 / 24577794.0, 887015 / 12288897.0, 70074185 / 73733382.0},
};

// Rec. 709, rounded to four digits.
inline double luminance(const glm::dvec3& rgb) { return 0.2126 * rgb.r + 0.7152 * rgb.g + 0.0722 * rgb.b; }

}  // namespace qtrace::experiments
