#include "engine/gltf/prism.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <utility>

namespace qtrace::gltf {
namespace {

// The part of it where `height`, which is linear, is not below 0 (Sutherland and Hodgman 1974).
template <class Height>
Polygon clipped(const Polygon& polygon, Height height) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const double at_a = height(a.position), at_b = height(b.position);
    if (at_a >= 0) result.push_back(a);
    if ((at_a < 0) == (at_b < 0)) continue;
    const double t = at_a / (at_a - at_b);
    result.push_back({glm::mix(a.position, b.position, t), glm::mix(a.barycentric, b.barycentric, t)});
  }
  return result;
}

}  // namespace

Polygon polygon_of(const Triangle& triangle) {
  return {{triangle.position[0], {1, 0, 0}},
          {triangle.position[1], {0, 1, 0}},
          {triangle.position[2], {0, 0, 1}}};
}

double area(const Polygon& polygon) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum +=
        glm::cross(polygon[i - 1].position - polygon[0].position, polygon[i].position - polygon[0].position);
  }
  return glm::length(sum) / 2;
}

bool is_wide(const Polygon& polygon, double width) {
  double around = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    around += glm::distance(polygon[i].position, polygon[(i + 1) % polygon.size()].position);
  }
  return area(polygon) > width * around / 2;
}

Prism::Prism(const Triangle& triangle) : normal_(glm::normalize(area_vector(triangle.position))) {
  for (std::size_t i = 0; i < 3; ++i) corners_[i] = triangle.position[i];
}

double Prism::height(const glm::dvec3& p) const { return glm::dot(normal_, p - corners_[0]); }

double Prism::within(std::size_t side, const glm::dvec3& p) const {
  const glm::dvec3 edge = glm::normalize(corners_[(side + 1) % 3] - corners_[side]);
  return glm::dot(glm::cross(normal_, edge), p - corners_[side]);
}

Polygon Prism::inside(Polygon polygon) const {
  for (std::size_t i = 0; i < 3 && !polygon.empty(); ++i) {
    polygon = clipped(polygon, [&](const glm::dvec3& p) { return within(i, p); });
  }
  return polygon;
}

void Prism::add_outside(Polygon polygon, double width, std::vector<Polygon>& parts) const {
  for (std::size_t i = 0; i < 3 && !polygon.empty(); ++i) {
    Polygon part = clipped(polygon, [&](const glm::dvec3& p) { return -within(i, p); });
    if (is_wide(part, width)) parts.push_back(std::move(part));
    polygon = clipped(polygon, [&](const glm::dvec3& p) { return within(i, p); });
  }
}

}  // namespace qtrace::gltf
