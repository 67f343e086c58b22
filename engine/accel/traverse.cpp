#include "engine/accel/traverse.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace qtrace {
namespace {

bool meets_box(const BvhNode& node, const Ray& ray, double t_max) {
  double near = 0;
  double far = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = node.lo[axis] - ray.origin[axis];
    const double hi = node.hi[axis] - ray.origin[axis];
    if (ray.direction[axis] == 0.0) {
      if (lo > 0 || hi < 0) return false;
      continue;
    }
    const double t0 = lo / ray.direction[axis];
    const double t1 = hi / ray.direction[axis];
    near = std::max(near, std::min(t0, t1));
    far = std::min(far, std::max(t0, t1));
  }
  return near <= far;
}

}  // namespace

// Moeller & Trumbore 1997.
std::optional<RayHit> intersect_triangle(const Scene& scene, std::uint32_t triangle, const Ray& ray) {
  if (triangle == kNoTriangle) return std::nullopt;
  const auto& p = scene.triangles[triangle].position;
  const glm::dvec3 edge1 = glm::dvec3(p[1]) - glm::dvec3(p[0]);
  const glm::dvec3 edge2 = glm::dvec3(p[2]) - glm::dvec3(p[0]);
  const glm::dvec3 cross_direction = glm::cross(ray.direction, edge2);
  const double det = glm::dot(edge1, cross_direction);
  if (det == 0.0) return std::nullopt;
  const glm::dvec3 s = ray.origin - glm::dvec3(p[0]);
  const double u = glm::dot(s, cross_direction) / det;
  const glm::dvec3 q = glm::cross(s, edge1);
  const double v = glm::dot(ray.direction, q) / det;
  const double t = glm::dot(edge2, q) / det;
  if (u < 0 || v < 0 || u + v > 1 || t <= 0) return std::nullopt;
  return RayHit{t, triangle, u, v};
}

std::optional<RayHit> closest_hit(const Scene& scene, const Bvh& bvh, const Ray& ray) {
  std::optional<RayHit> best;
  std::uint32_t index = 0;
  while (index != kNoNode) {
    const BvhNode& node = bvh.nodes[index];
    const double t_max = best ? best->t : std::numeric_limits<double>::infinity();
    const bool inside = meets_box(node, ray, t_max);
    if (inside) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const auto hit = intersect_triangle(scene, bvh.order[i], ray);
        if (hit && (!best || hit->t < best->t)) best = hit;
      }
    }
    index = inside && node.count == 0 ? index + 1 : node.miss;
  }
  return best;
}

}  // namespace qtrace
