// What of a polygon is over a triangle, and what is not.
#pragma once

#include "engine/gltf/triangle.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace qtrace::gltf {

// A corner of a part of a triangle, and where on the triangle it is.
struct Corner {
  glm::dvec3 position;
  glm::dvec3 barycentric;
};
Corner mixed(const Corner& a, const Corner& b, double x);  // at x of the way from a to b
// Flat and convex.
using Polygon = std::vector<Corner>;

Polygon polygon_of(const Triangle& triangle);
double area(const Polygon& polygon);
// Whether it is wider than `width`, nearly.
bool is_wide(const Polygon& polygon, double width);

// All that is above or below a triangle, at any height.
class Prism {
 public:
  explicit Prism(const Triangle& triangle);

  // Above the triangle's plane.
  double height(const glm::dvec3& p) const;

  Polygon inside(Polygon polygon) const;

  // Adds to `parts` what of `polygon` is outside, in convex pieces that are wider than `width`.
  void add_outside(Polygon polygon, double width, std::vector<Polygon>& parts) const;

 private:
  // Inside of a side's plane.
  double within(std::size_t side, const glm::dvec3& p) const;

  glm::dvec3 normal_;
  std::array<glm::dvec3, 3> corners_;
};

}  // namespace qtrace::gltf
