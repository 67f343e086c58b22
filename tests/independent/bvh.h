// Rays against triangles: a hierarchy of boxes, split in the middle of the triangles' centres.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace qtrace::independent {

struct Ray {
  glm::dvec3 origin;
  glm::dvec3 direction;
};

struct Hit {
  double t = std::numeric_limits<double>::infinity();  // in lengths of the direction
  std::uint32_t triangle = 0;
  double u = 0, v = 0;  // weights of the second and third vertex
  explicit operator bool() const { return t < std::numeric_limits<double>::infinity(); }
};

class Bvh {
 public:
  explicit Bvh(const Scene& scene);
  // The nearest hit at t in (t_min, t_max), from either side.
  Hit closest(const Ray& ray, double t_min, double t_max = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    glm::dvec3 lo, hi;
    std::size_t first = 0, count = 0;  // of order_; no triangles in inner nodes
    std::size_t right = 0;             // child; the left one follows its parent
  };
  std::size_t build(std::size_t first, std::size_t last);

  const Scene& scene_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace qtrace::independent
