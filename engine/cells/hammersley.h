#pragma once

#include <glm/vec2.hpp>

#include <cstdint>

namespace qtrace {

// Point i of n of the Hammersley set: (i + 1/2) / n and the radical inverse of i in base 2
// (Niederreiter 1992, section 3.1; centred in its stratum). Both in [0, 1).
inline glm::dvec2 hammersley(std::uint32_t i, std::uint32_t n) {
  std::uint32_t bits = i;
  bits = (bits << 16) | (bits >> 16);
  bits = ((bits & 0x00ff00ffU) << 8) | ((bits & 0xff00ff00U) >> 8);
  bits = ((bits & 0x0f0f0f0fU) << 4) | ((bits & 0xf0f0f0f0U) >> 4);
  bits = ((bits & 0x33333333U) << 2) | ((bits & 0xccccccccU) >> 2);
  bits = ((bits & 0x55555555U) << 1) | ((bits & 0xaaaaaaaaU) >> 1);
  return {(i + 0.5) / n, bits / 4294967296.0};
}

}  // namespace qtrace
