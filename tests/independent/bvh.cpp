#include "tests/independent/bvh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace qtrace::independent {
namespace {

glm::dvec3 centre(const Triangle& t) {
  return (glm::dvec3(t.position[0]) + glm::dvec3(t.position[1]) + glm::dvec3(t.position[2])) / 3.0;
}

bool meets_box(const Ray& ray, const glm::dvec3& lo, const glm::dvec3& hi, double t_max) {
  double near = 0;
  double far = t_max;
  for (int k = 0; k < 3; ++k) {
    if (ray.direction[k] == 0) {
      if (ray.origin[k] < lo[k] || ray.origin[k] > hi[k]) return false;
      continue;
    }
    double a = (lo[k] - ray.origin[k]) / ray.direction[k];
    double b = (hi[k] - ray.origin[k]) / ray.direction[k];
    if (a > b) std::swap(a, b);
    near = std::max(near, a);
    far = std::min(far, b * (1 + 1e-14));
  }
  return near <= far;
}

// Solves origin + t direction = p0 + u e1 + v e2 by Cramer's rule.
void meet_triangle(const Ray& ray, const Triangle& triangle, std::uint32_t index, double t_min, Hit& hit) {
  const glm::dvec3 p0(triangle.position[0]);
  const glm::dvec3 e1 = glm::dvec3(triangle.position[1]) - p0;
  const glm::dvec3 e2 = glm::dvec3(triangle.position[2]) - p0;
  const glm::dvec3 normal = glm::cross(e1, e2);
  const double determinant = -glm::dot(ray.direction, normal);
  if (determinant == 0) return;
  const glm::dvec3 s = ray.origin - p0;
  const double t = glm::dot(s, normal) / determinant;
  const glm::dvec3 q = glm::cross(s, ray.direction);
  const double u = glm::dot(e2, q) / determinant;
  const double v = -glm::dot(e1, q) / determinant;
  constexpr double kEdge = -1e-12;  // neighbours overlap by a hair, so that no ray passes between them
  if (u < kEdge || v < kEdge || u + v > 1 - kEdge || t <= t_min || t >= hit.t) return;
  hit = {t, index, u, v};
}

}  // namespace

Bvh::Bvh(const Scene& scene) : scene_(scene), order_(scene.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, order_.size());
}

std::size_t Bvh::build(std::size_t first, std::size_t last) {
  const std::size_t index = nodes_.size();
  glm::dvec3 lo(1e300), hi(-1e300), low(1e300), high(-1e300);
  for (std::size_t i = first; i < last; ++i) {
    const Triangle& t = scene_.triangles[order_[i]];
    for (const glm::vec3& p : t.position) {
      lo = glm::min(lo, glm::dvec3(p));
      hi = glm::max(hi, glm::dvec3(p));
    }
    low = glm::min(low, centre(t));
    high = glm::max(high, centre(t));
  }
  nodes_.push_back({lo, hi, first, last - first, 0});
  if (last - first <= 4) return index;
  const glm::dvec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = (first + last) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
    return centre(scene_.triangles[a])[axis] < centre(scene_.triangles[b])[axis];
  });
  build(first, middle);
  const std::size_t right = build(middle, last);
  nodes_[index].count = 0;
  nodes_[index].right = right;
  return index;
}

Hit Bvh::closest(const Ray& ray, double t_min, double t_max) const {
  Hit hit;
  if (order_.empty()) return hit;
  hit.t = t_max;
  std::size_t stack[64] = {0};
  int depth = 1;
  while (depth > 0) {
    const std::size_t index = stack[--depth];
    const Node& node = nodes_[index];
    if (!meets_box(ray, node.lo, node.hi, hit.t)) continue;
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      meet_triangle(ray, scene_.triangles[order_[i]], order_[i], t_min, hit);
    }
    if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
    }
  }
  if (hit.t == t_max) hit.t = std::numeric_limits<double>::infinity();
  return hit;
}

}  // namespace qtrace::independent
