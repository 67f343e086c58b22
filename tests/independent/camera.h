// Rays through a place of the picture.
#pragma once

#include "engine/scene/scene.h"
#include "tests/independent/bvh.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <cmath>

namespace qtrace::independent {

// x and y in pixels from the upper left corner.
inline Ray camera_ray(const Camera& camera, double x, double y, int width, int height) {
  const glm::dmat4 m(camera.world_from_camera);
  const bool is_parallel = camera.film_height > 0;
  const double up = is_parallel ? 0.5 * camera.film_height : std::tan(0.5 * camera.vertical_fov);
  const glm::dvec2 on_film((2 * x / width - 1) * up * width / height, (1 - 2 * y / height) * up);
  if (is_parallel) return {glm::dvec3(m * glm::dvec4(on_film, 0, 1)), -glm::normalize(glm::dvec3(m[2]))};
  return {glm::dvec3(m[3]), glm::normalize(glm::dvec3(m * glm::dvec4(on_film, -1, 0)))};
}

}  // namespace qtrace::independent
