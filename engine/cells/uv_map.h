// Which triangles of an object lie over a point of its UV square.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <vector>

namespace qtrace {

struct UvHit {
  std::uint32_t triangle = 0;  // index in Scene::triangles
  double u = 0;                // barycentric weights of the second and third vertex
  double v = 0;
};

// Coordinates outside of [0, 1) repeat, as texture coordinates do.
class UvMap {
 public:
  UvMap(const Scene& scene, const Object& object);

  // All triangles over `point` in [0, 1)^2, in their order.
  std::vector<UvHit> find(glm::dvec2 point) const;

 private:
  struct Chart {
    std::uint32_t triangle;
    glm::dvec2 corner[3];  // shifted by whole tiles
  };

  std::size_t row_of(double v) const;
  void add(std::uint32_t triangle, const std::array<glm::vec2, 3>& uv);

  std::vector<Chart> charts_;
  std::vector<std::vector<std::uint32_t>> rows_;  // charts that overlap a strip of the square
};

}  // namespace qtrace
