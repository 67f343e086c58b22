// Triangles of one mesh node, brought to world space.
#pragma once

#include "engine/gltf/pose.h"
#include "engine/scene/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <cstddef>
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
};

class TrianglePlacer {
 public:
  // `object` is what messages call it.
  TrianglePlacer(const Source& source, std::string object, const Pose& pose);

  // Nothing where the triangle has no area in world space. Material and object are left to the caller.
  std::optional<Triangle> place(const Primitive& primitive, std::size_t index);

  const Losses& losses() const { return losses_; }
  // The largest coordinate of a position that was turned and scaled as its node is, and not yet moved.
  float extent() const { return static_cast<float>(extent_); }

 private:
  void note_flat(const Primitive& primitive, std::size_t index);
  glm::vec3 world_position(const Primitive& primitive, std::uint32_t vertex);
  glm::vec3 world_normal(const Primitive& primitive, std::uint32_t vertex, const glm::dvec3& face_normal);
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
