#pragma once

#include "engine/scene/scene.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <limits>

namespace qtrace {

struct Bounds {
  glm::vec3 lo{std::numeric_limits<float>::max()};
  glm::vec3 hi{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  void add(const Bounds& other) {
    lo = glm::min(lo, other.lo);
    hi = glm::max(hi, other.hi);
  }
  // Halved first: the sum of two large coordinates could overflow.
  glm::vec3 centre() const { return lo * 0.5F + hi * 0.5F; }
  int longest_axis() const {
    const glm::vec3 size = hi - lo;
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
  }
};

// Half the surface.
inline float half_area(const Bounds& b) {
  const glm::vec3 size = b.hi - b.lo;
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

inline Bounds bounds_of(const Triangle& triangle) {
  Bounds bounds;
  for (const glm::vec3& p : triangle.position) bounds.add(p);
  return bounds;
}

}  // namespace qtrace
