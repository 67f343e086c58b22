// A regular grid of boxes, and the pieces of triangles that lie in them.
#pragma once

#include "engine/cells/corner.h"
#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>

namespace qtrace {

inline constexpr std::uint32_t kGridNormals = 6;  // x, -x, y, -y, z, -z: the axis that a normal is nearest to

// Cubes; an entry for each of them and each of the six axes.
struct GridFrame {
  glm::vec3 origin{0.0F};
  float boxes_per_unit = 0.0F;
  glm::uvec3 boxes{0};  // along each axis

  std::size_t entries() const { return std::size_t{boxes.x} * boxes.y * boxes.z * kGridNormals; }
  std::size_t entry(glm::uvec3 box, std::uint32_t normal) const {
    return ((std::size_t{box.z} * boxes.y + box.y) * boxes.x + box.x) * kGridNormals + normal;
  }
};

// A triangle in units of boxes, and how far its points may be off where the device finds them in single
// precision.
struct BoxedTriangle {
  Polygon polygon;
  double slack = 0;  // boxes
};
BoxedTriangle boxed(const GridFrame& frame, const Triangle& triangle);

// What of the triangle lies in each box, which reaches into its neighbours by the slack. In units of boxes.
void for_each_piece(const GridFrame& frame, const BoxedTriangle& triangle,
                    const std::function<void(glm::uvec3 box, const Polygon& piece)>& visit);

// Rounding of a normal's components on the device.
inline constexpr double kNormalSlack = 1e-4;

// What of the polygon has a normal whose largest component lies along `side` (1 or -1) of axis k.
Polygon pointing_along(Polygon polygon, int k, double side);

}  // namespace qtrace
