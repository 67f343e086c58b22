#include "engine/gltf/prism.h"

#include "engine/scene/clip.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <utility>

namespace qtrace::gltf {
Corner mixed(const Corner& a, const Corner& b, double x) {
  return {glm::mix(a.position, b.position, x), glm::mix(a.barycentric, b.barycentric, x)};
}

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
    polygon = clip(polygon, [&](const Corner& corner) { return within(i, corner.position); });
  }
  return polygon;
}

void Prism::add_outside(Polygon polygon, double width, std::vector<Polygon>& parts) const {
  for (std::size_t i = 0; i < 3 && !polygon.empty(); ++i) {
    Polygon part = clip(polygon, [&](const Corner& corner) { return -within(i, corner.position); });
    if (is_wide(part, width)) parts.push_back(std::move(part));
    polygon = clip(polygon, [&](const Corner& corner) { return within(i, corner.position); });
  }
}

}  // namespace qtrace::gltf
