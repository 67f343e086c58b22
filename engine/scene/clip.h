// Polygons cut by planes.
#pragma once

#include <cstddef>
#include <vector>

namespace qtrace {

// What of a convex polygon has a height of at least 0, for a height that is linear in its corners: one step
// of Sutherland & Hodgman 1974, "Reentrant Polygon Clipping". `mixed(a, b, x)` is the corner at x of the way
// from one to another.
template <class Corner, class Height>
std::vector<Corner> clip(const std::vector<Corner>& polygon, const Height& height) {
  std::vector<Corner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const double height_a = height(a);
    const double height_b = height(b);
    if (height_a >= 0) kept.push_back(a);
    if ((height_a >= 0) == (height_b >= 0)) continue;
    kept.push_back(mixed(a, b, height_a / (height_a - height_b)));
  }
  return kept;
}

}  // namespace qtrace
