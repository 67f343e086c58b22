// Scenes whose radiance has a closed form, built in memory.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

namespace qtrace {

// A closed cube about `centre`, all of whose walls are Lambert with `albedo` and emit `emission` inwards; the
// camera stands in its middle. Six objects with UV maps. In it every path meets the same walls, whatever its
// directions, and after at most N scattering events the radiance is
//   emission (1 - albedo^(N+1)) / (1 - albedo), the first N + 1 terms of the Neumann series.
Scene furnace_box(float albedo, float emission, float half_size = 1.0F, glm::vec3 centre = glm::vec3(0.0F));
double furnace_radiance(double albedo, double emission, int max_bounces);

// A Lambert floor at y = 0, 20 x 20, under a black square light of side `light_side` at y = `light_height`
// that emits `emission` downwards, both about the y axis. The camera looks at the floor's middle from the
// side.
struct LitFloor {
  Scene scene;
  float albedo = 0.0F;
  float emission = 0.0F;
  float light_side = 0.0F;
  float light_height = 0.0F;

  // Radiance that leaves the floor at (x, 0, z) for max_bounces = 1: albedo / pi times the irradiance
  // E = pi Le F, F from four rectangles with a corner over the point (Howell, configuration B-4).
  double radiance(double x, double z) const;
};
LitFloor lit_floor(float albedo, float emission, float light_side, float light_height);

// Adds a parallelogram from `corner` along `edge_u` and `edge_v` as an object of its own; its front face is
// on the side of cross(edge_u, edge_v), its UV map the unit square.
void add_quad(Scene& scene, glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v, std::uint32_t material);

// A camera at `eye` towards `target`, y up.
Camera look_at(glm::vec3 eye, glm::vec3 target, float vertical_fov);

// A Lambert material.
Material lambert(glm::vec3 albedo, glm::vec3 emission = glm::vec3(0.0F));

}  // namespace qtrace
