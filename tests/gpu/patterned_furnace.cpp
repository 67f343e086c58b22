#include "tests/gpu/patterned_furnace.h"

#include "engine/scene/analytic.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace qtrace::test {
namespace {

constexpr int kPanels = 12;  // along a wall's side
constexpr double kAlbedo = 0.5;

using Quad = std::array<glm::dvec3, 4>;  // corners in turn

// From a point with normal n to a polygon, by its edges (Lambert 1760).
double form_factor(glm::dvec3 point, glm::dvec3 normal, const Quad& quad) {
  double sum = 0;
  for (std::size_t i = 0; i < quad.size(); ++i) {
    const glm::dvec3 a = glm::normalize(quad[i] - point);
    const glm::dvec3 b = glm::normalize(quad[(i + 1) % quad.size()] - point);
    const glm::dvec3 c = glm::cross(a, b);
    sum += std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * glm::dot(normal, c / glm::length(c));
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

// The square that an object's first triangle is half of.
Quad square_of(const Scene& box, std::uint32_t object) {
  const Triangle& t = box.triangles[box.objects[object].first_triangle];
  const glm::dvec3 a = t.position[0];
  const glm::dvec3 b = t.position[1];
  const glm::dvec3 c = t.position[2];
  const double ab = glm::length(a - b);
  const double bc = glm::length(b - c);
  const double ca = glm::length(c - a);
  // Opposite corners lie farthest apart.
  if (ab > bc && ab > ca) return {a, c, b, a + b - c};
  if (bc > ab && bc > ca) return {b, a, c, b + c - a};
  return {c, b, a, c + a - b};
}

double emission_at(glm::dvec3 point, glm::dvec3 normal, const std::array<Quad, 6>& walls, std::size_t wall) {
  double received = 0;
  for (std::size_t other = 0; other < walls.size(); ++other) {
    if (other != wall) received += kWallRadiance[other] * form_factor(point, normal, walls[other]);
  }
  return kWallRadiance[wall] - kAlbedo * received;
}

void add_wall(Scene& scene, const std::array<Quad, 6>& walls, std::size_t wall) {
  const Quad& quad = walls[wall];
  glm::dvec3 u = (quad[1] - quad[0]) / double{kPanels};
  glm::dvec3 v = (quad[3] - quad[0]) / double{kPanels};
  const glm::dvec3 inwards = glm::normalize(-(quad[0] + quad[2]));
  if (glm::dot(glm::cross(u, v), inwards) < 0) std::swap(u, v);
  for (int i = 0; i < kPanels * kPanels; ++i) {
    const glm::dvec3 corner = quad[0] + u * double(i % kPanels) + v * double(i / kPanels);
    const double emission = emission_at(corner + (u + v) * 0.5, inwards, walls, wall);
    scene.materials.push_back(lambert(glm::vec3(kAlbedo), glm::vec3(static_cast<float>(emission))));
    add_quad(scene, corner, u, v, static_cast<std::uint32_t>(scene.materials.size() - 1));
  }
}

}  // namespace

Scene patterned_furnace() {
  const Scene box = furnace_box(kAlbedo, 1.0F);
  std::array<Quad, 6> walls;
  for (std::uint32_t w = 0; w < 6; ++w) walls[w] = square_of(box, w);
  Scene scene;
  scene.camera = box.camera;
  for (std::size_t w = 0; w < 6; ++w) add_wall(scene, walls, w);
  // A wall is one object, so that its cells span panels.
  constexpr std::uint32_t kTriangles = 2 * kPanels * kPanels;
  scene.objects.clear();
  for (std::uint32_t w = 0; w < 6; ++w) {
    Object wall = box.objects[w];
    wall.first_triangle = w * kTriangles;
    wall.triangle_count = kTriangles;
    wall.has_uv = false;
    scene.objects.push_back(wall);
  }
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) scene.triangles[i].object = i / kTriangles;
  return scene;
}

}  // namespace qtrace::test
