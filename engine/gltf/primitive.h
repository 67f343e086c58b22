// One mesh primitive as a list of triangles in the mesh's own space.
#pragma once

#include "engine/gltf/accessor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace qtrace::gltf {

class Primitive {
 public:
  // Error where an attribute is missing, malformed or outside its buffer.
  Primitive(const Source& source, std::size_t mesh, std::size_t primitive);

  bool is_surface() const;  // false for points and lines
  bool has_uv() const { return uv_.has_value(); }
  bool has_normals() const { return normals_.has_value(); }
  int material() const { return material_; }
  int mode() const { return mode_; }
  const std::string& place() const { return place_; }

  std::size_t triangle_count() const;
  // The vertices of a triangle in counter-clockwise order; Error where an index points at none.
  std::array<std::uint32_t, 3> triangle(const Source& source, std::size_t i) const;

  glm::vec3 position(const Source& source, std::uint32_t vertex) const;
  glm::vec3 normal(const Source& source, std::uint32_t vertex) const;
  glm::vec2 uv(const Source& source, std::uint32_t vertex) const;

 private:
  std::size_t corner_count() const;
  std::uint32_t vertex(const Source& source, std::size_t corner) const;

  std::string place_;
  int mode_ = 0;
  int material_ = -1;
  std::optional<AccessorView> positions_;
  std::optional<AccessorView> normals_;
  std::optional<AccessorView> uv_;
  std::optional<AccessorView> indices_;
};

}  // namespace qtrace::gltf
