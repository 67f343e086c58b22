// Triangles of one mesh node, brought to world space.
#pragma once

#include "engine/gltf/pose.h"
#include "engine/scene/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace qtrace::gltf {

// How often place() could not use what the file says.
struct Losses {
  std::size_t triangles = 0;       // all, with those that are lost
  std::size_t flat_triangles = 0;  // without area, and dropped
  std::string flat_names;          // of the first few
  std::size_t zero_normals = 0;
  std::size_t opposed_normals = 0;  // not on the front side of their triangle
  std::size_t odd_colors = 0;       // outside of 0 to 1
};

// A triangle in the world, and the attributes that few have.
struct PlacedTriangle {
  Triangle triangle;
  TriangleAttributes attributes;
};

class TrianglePlacer {
 public:
  // `object` is what messages call it.
  TrianglePlacer(const Source& source, std::string object, const Pose& pose);

  // Nothing where the triangle has no area in world space. Material and object are left to the caller, and
  // tangents where the primitive has none.
  std::optional<PlacedTriangle> place(const Primitive& primitive, std::size_t index);

  const Losses& losses() const { return losses_; }
  // The largest coordinate of a position that was turned and scaled as its node is, and not yet moved.
  float extent() const { return static_cast<float>(extent_); }

 private:
  void note_flat(const Primitive& primitive, std::size_t index);
  glm::vec3 world_position(const Primitive& primitive, std::uint32_t vertex);
  glm::vec3 world_normal(const Primitive& primitive, std::uint32_t vertex, const glm::dvec3& face_normal);
  glm::vec4 world_tangent(const Primitive& primitive, std::uint32_t vertex, const glm::vec3& normal) const;
  glm::vec4 color(const Primitive& primitive, std::uint32_t vertex);
  TriangleAttributes attributes(const Primitive& primitive, const std::array<std::uint32_t, 3>& vertices,
                                const Triangle& triangle);
  bool is_mirrored(const Primitive& primitive, std::uint32_t vertex) const;

  const Source& source_;
  std::string object_;
  const Pose& pose_;
  glm::dmat3 normal_to_world_;  // of what is rigid, as the next
  bool is_mirrored_;
  Losses losses_;
  double extent_ = 0;
};

}  // namespace qtrace::gltf
