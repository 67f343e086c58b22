#pragma once

#include <cstdint>

namespace qtrace {

// Work groups cover squares of 8 x 8 pixels (camera.glsl): how many stand along a side of the image.
inline std::uint32_t tiles(int pixels) {
  constexpr std::uint32_t kTile = 8;
  return (static_cast<std::uint32_t>(pixels) + kTile - 1) / kTile;
}

}  // namespace qtrace
