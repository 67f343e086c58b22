// Pieces of triangles, with their interpolated normals.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace qtrace {

struct Corner {
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0};  // as interpolated, not unit
};

using Polygon = std::vector<Corner>;  // convex

// What of a polygon has a height of at least 0, for a height that is linear in position and normal: one step
// of Sutherland & Hodgman 1974, "Reentrant Polygon Clipping".
template <class Height>
Polygon clip(const Polygon& polygon, const Height& height) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const double height_a = height(a);
    const double height_b = height(b);
    if (height_a >= 0) kept.push_back(a);
    if ((height_a >= 0) == (height_b >= 0)) continue;
    const double x = height_a / (height_a - height_b);
    kept.push_back({glm::mix(a.position, b.position, x), glm::mix(a.normal, b.normal, x)});
  }
  return kept;
}

}  // namespace qtrace
