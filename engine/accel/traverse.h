// Traversal on the CPU, in double precision: the oracle that tests hold the GPU's against.
#pragma once

#include "engine/accel/bvh.h"

#include <glm/vec3.hpp>

#include <optional>

namespace qtrace {

struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0.0};  // need not be unit
};

struct RayHit {
  double t = 0;                // in units of the direction, > 0
  std::uint32_t triangle = 0;  // index in Scene::triangles
  double u = 0;                // barycentric weights of the second and third vertex
  double v = 0;
};

// Either side of a triangle is hit. Nullopt for a ray that leaves it aside, and for a parallel one.
std::optional<RayHit> intersect_triangle(const Scene& scene, std::uint32_t triangle, const Ray& ray);

std::optional<RayHit> closest_hit(const Scene& scene, const Bvh& bvh, const Ray& ray);

}  // namespace qtrace
