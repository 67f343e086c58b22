// How OpenEXR is handed the memory of planes of floats.
#pragma once

#include "engine/core/check.h"

#include <ImfFrameBuffer.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace qtrace::experiments {

constexpr int kMaxSide = 65'536;

inline void check_window(const Imath::Box2i& window) {
  const auto width = std::int64_t{window.max.x} - window.min.x + 1;
  const auto height = std::int64_t{window.max.y} - window.min.y + 1;
  check(width > 0 && width <= kMaxSide && height > 0 && height <= kMaxSide,
        "{}x{} pixels are not between 1 and {} each way", width, height, kMaxSide);
}

// A plane whose first value belongs to the pixel (left, top) of a file. OpenEXR addresses pixels from its
// own origin, hence the shifted base, which is computed as an integer because it may lie outside the plane.
inline Imf::Slice plane_slice(std::vector<float>& plane, const Imath::Box2i& window, std::size_t width) {
  const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(width * sizeof(float));
  const std::ptrdiff_t offset =
      window.min.x * static_cast<std::ptrdiff_t>(sizeof(float)) + window.min.y * row;
  const auto base = reinterpret_cast<std::intptr_t>(plane.data()) - offset;
  return {Imf::FLOAT, reinterpret_cast<char*>(base), sizeof(float), width * sizeof(float)};
}

}  // namespace qtrace::experiments
