// Pieces of triangles, with their interpolated normals.
#pragma once

#include "engine/scene/clip.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace qtrace {

struct Corner {
  glm::dvec3 position{0.0};
  glm::dvec3 normal{0.0};  // as interpolated, not unit
};

inline Corner mixed(const Corner& a, const Corner& b, double x) {
  return {glm::mix(a.position, b.position, x), glm::mix(a.normal, b.normal, x)};
}

using Polygon = std::vector<Corner>;  // convex

}  // namespace qtrace
