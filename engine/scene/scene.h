// A scene as plain data in world space: what the loader makes and everything downstream reads.
#pragma once

#include "engine/scene/lights.h"
#include "engine/scene/material.h"
#include "engine/scene/texture.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace qtrace {

// Of a triangle's corners, what few scenes have.
struct TriangleAttributes {
  std::array<glm::vec2, 3> uv1{};  // TEXCOORD_1; zero where the file has none
  // xyz: unit, in the world, along growing u of the normal texture; w: 1 or -1: w cross(normal, tangent)
  // points up in the image, where v falls. Every triangle whose material has a texture of normals has them.
  std::array<glm::vec4, 3> tangent{};
  // COLOR_0: base colour and opacity are multiplied with it; linear.
  std::array<glm::vec4, 3> color{glm::vec4(1), glm::vec4(1), glm::vec4(1)};

  bool operator==(const TriangleAttributes&) const = default;
};
inline constexpr std::uint32_t kNoAttributes = 0xffffffffU;

// Counter-clockwise order seen from the front, also under a mirroring node transform.
struct Triangle {
  std::array<glm::vec3, 3> position;
  std::array<glm::vec3, 3> normal;  // unit, on the front side; the face normal where the file has none
  std::array<glm::vec2, 3> uv;      // zero where the object has no UV map
  std::uint32_t material = 0;
  std::uint32_t object = 0;
  std::uint32_t attributes = kNoAttributes;  // of Scene::attributes
};

// Along the face normal, twice the triangle's area long; in double precision, which tells from float
// positions whether they span an area at all.
inline glm::dvec3 area_vector(const std::array<glm::vec3, 3>& position) {
  const glm::dvec3 first(position[0]);
  return glm::cross(glm::dvec3(position[1]) - first, glm::dvec3(position[2]) - first);
}

inline double area_of(const Triangle& triangle) { return 0.5 * glm::length(area_vector(triangle.position)); }

// One mesh node. Its triangles stand together in Scene::triangles.
struct Object {
  std::string name;
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  bool has_uv = false;
};

// Looks along -z of `world_from_camera`, y up, as in glTF. The image's aspect ratio decides the width.
struct Camera {
  glm::mat4 world_from_camera{1.0F};  // rotation and translation only
  float vertical_fov = 1.0F;          // radians, in (0, pi); of a perspective camera
  float film_height = 0;  // of an orthographic camera, in units of the world; 0: a perspective one
};

struct Scene {
  std::string name;  // the file's name without folder and extension
  std::vector<Triangle> triangles;
  std::vector<TriangleAttributes> attributes;
  std::vector<Material> materials;
  std::vector<TextureImage> images;
  std::vector<Object> objects;
  std::vector<PunctualLight> lights;
  std::optional<EnvironmentMap> environment;  // in place of the constant one of the settings
  Camera camera;
  glm::dvec3 origin{0.0};  // of positions here, in the file's world; other than zero far from there
  std::vector<std::string> warnings;  // what the file holds and the tracer does not model, one sentence each
};

}  // namespace qtrace
