#include "engine/scene/analytic.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace qtrace {
namespace {

// Configuration factor from a point to a parallel rectangle a x b at distance c, one corner over the point,
// as an odd function of a and b, so that signed pieces add up.
double corner_factor(double a, double b, double c) {
  const double x = a / c;
  const double y = b / c;
  const double root_x = std::sqrt(1 + x * x);
  const double root_y = std::sqrt(1 + y * y);
  return (x / root_x * std::atan(y / root_x) + y / root_y * std::atan(x / root_y)) / (2 * std::numbers::pi);
}

}  // namespace

Material lambert(glm::vec3 albedo, glm::vec3 emission) {
  Material m;
  m.name = "lambert";
  m.base_color = albedo;
  m.metallic = 0;
  m.specular = 0;
  m.emission = emission;
  return m;
}

void add_quad(Scene& scene, glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v, std::uint32_t material) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  const glm::vec3 n = glm::normalize(glm::cross(edge_u, edge_v));
  const glm::vec3 far = corner + edge_u + edge_v;
  scene.objects.push_back({"quad", static_cast<std::uint32_t>(scene.triangles.size()), 2, true});
  const glm::vec2 a(0, 0);
  const glm::vec2 b(1, 0);
  const glm::vec2 c(1, 1);
  const glm::vec2 d(0, 1);
  scene.triangles.push_back({{corner, corner + edge_u, far}, {n, n, n}, {a, b, c}, material, object});
  scene.triangles.push_back({{corner, far, corner + edge_v}, {n, n, n}, {a, c, d}, material, object});
}

Camera look_at(glm::vec3 eye, glm::vec3 target, float vertical_fov) {
  const glm::vec3 forward = glm::normalize(target - eye);
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward);
  Camera camera;
  camera.world_from_camera =
      glm::mat4(glm::vec4(right, 0), glm::vec4(up, 0), glm::vec4(-forward, 0), glm::vec4(eye, 1));
  camera.vertical_fov = vertical_fov;
  return camera;
}

Scene furnace_box(float albedo, float emission, float half_size, glm::vec3 centre) {
  Scene scene;
  scene.name = "furnace_box";
  scene.materials.push_back(lambert(glm::vec3(albedo), glm::vec3(emission)));
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0F, 1.0F}) {
      glm::vec3 u(0);
      glm::vec3 v(0);
      glm::vec3 n(0);
      u[(axis + 1) % 3] = 2 * half_size;
      v[(axis + 2) % 3] = 2 * half_size;
      n[axis] = side * half_size;
      // u x v points along +axis; walls face the middle.
      if (side > 0) std::swap(u, v);
      add_quad(scene, centre + n - (u + v) * 0.5F, u, v, 0);
    }
  }
  constexpr float kFov = 1.2F;
  scene.camera = look_at(centre, centre + half_size * glm::vec3(0.3F, 0.2F, -1), kFov);
  return scene;
}

double furnace_radiance(double albedo, double emission, int max_bounces) {
  double sum = 0;
  for (int n = 0; n <= max_bounces; ++n) sum += emission * std::pow(albedo, n);
  return sum;
}

LitFloor lit_floor(float albedo, float emission, float light_side, float light_height) {
  LitFloor lit{{}, albedo, emission, light_side, light_height};
  Scene& scene = lit.scene;
  scene.name = "lit_floor";
  scene.materials = {lambert(glm::vec3(albedo)), lambert(glm::vec3(0), glm::vec3(emission))};
  constexpr float kFloor = 20;
  add_quad(scene, {-kFloor / 2, 0, -kFloor / 2}, {0, 0, kFloor}, {kFloor, 0, 0}, 0);
  const float half = light_side / 2;
  add_quad(scene, {-half, light_height, -half}, {light_side, 0, 0}, {0, 0, light_side}, 1);
  constexpr float kFov = 0.1F;
  scene.camera = look_at({light_height * 2, light_height / 2, 0.1F}, {0, 0, 0}, kFov);
  return lit;
}

double LitFloor::radiance(double x, double z) const {
  const double half = light_side / 2.0;
  const double h = light_height;
  const double factor = corner_factor(half - x, half - z, h) + corner_factor(half + x, half - z, h) +
                        corner_factor(half - x, half + z, h) + corner_factor(half + x, half + z, h);
  return albedo * emission * factor;
}

}  // namespace qtrace
