// One mesh primitive as a list of triangles in the mesh's own space.
#pragma once

#include "engine/gltf_document/accessor.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::gltf {

// What not every reader of a primitive asks for.
struct Extras {
  bool uv1 = false;
  bool tangents = false;
  bool colors = false;
};

class Primitive {
 public:
  // Error where an attribute is missing, malformed or outside its buffer. `weights`: of its morph targets;
  // none where all are 0. Of the attributes in `extras` none but those are opened that are wanted.
  Primitive(const Source& source, std::size_t mesh, std::size_t primitive,
            const std::vector<double>& weights = {}, const Extras& extras = {});

  bool is_surface() const;  // false for points, lines and what has no positions
  bool has_uv() const { return uv_.has_value(); }
  bool has_uv1() const { return uv1_.has_value(); }
  bool has_normals() const { return normals_.has_value(); }
  // glTF 2.0, section 3.7.2.1: without normals, tangents do not count.
  bool has_tangents() const { return normals_.has_value() && tangents_.has_value(); }
  bool has_colors() const { return colors_.has_value(); }
  // Whether a triangle is there to join two strips, and has no area for that reason.
  bool joins(const std::array<std::uint32_t, 3>& triangle) const {
    return mode_ == TINYGLTF_MODE_TRIANGLE_STRIP &&
           (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]);
  }
  bool has_joints() const { return !joints_.empty(); }
  int material() const { return material_; }
  int mode() const { return mode_; }
  const std::string& place() const { return place_; }

  std::size_t triangle_count() const;
  // The vertices of a triangle in counter-clockwise order; Error where an index points at none.
  std::array<std::uint32_t, 3> triangle(const Source& source, std::size_t i) const;

  glm::vec3 position(const Source& source, std::uint32_t vertex) const;
  glm::vec3 normal(const Source& source, std::uint32_t vertex) const;
  glm::vec2 uv(const Source& source, std::uint32_t vertex) const;
  glm::vec2 uv1(const Source& source, std::uint32_t vertex) const;
  glm::vec4 tangent(const Source& source, std::uint32_t vertex) const;
  glm::vec4 color(const Source& source, std::uint32_t vertex) const;  // as the file has it

  // A joint of the skin, and how far a vertex follows it.
  struct Influence {
    std::uint32_t joint;
    double weight;
  };
  // Those above 0; their weights add up to 1. Error where there is none.
  std::vector<Influence> influences(const Source& source, std::uint32_t vertex) const;

 private:
  struct Target {
    double weight;
    std::optional<AccessorView> positions;
    std::optional<AccessorView> normals;
    std::optional<AccessorView> tangents;
  };
  struct Joints {
    AccessorView indices;
    AccessorView weights;
  };
  void open_extras(const Source& source, const tinygltf::Primitive& file, const Extras& extras);
  void open_targets(const Source& source, const tinygltf::Primitive& file,
                    const std::vector<double>& weights);
  void open_joints(const Source& source, const tinygltf::Primitive& file);
  void check_count(const Source& source, const AccessorView& attribute) const;
  std::size_t corner_count() const;
  std::uint32_t vertex(const Source& source, std::size_t corner) const;

  std::string place_;
  int mode_ = 0;
  int material_ = -1;
  std::optional<AccessorView> positions_;
  std::optional<AccessorView> normals_;
  std::optional<AccessorView> uv_;
  std::optional<AccessorView> uv1_;
  std::optional<AccessorView> tangents_;
  std::optional<AccessorView> colors_;
  bool has_opacity_ = false;  // in its colours
  std::optional<AccessorView> indices_;
  std::vector<Target> targets_;  // those with a weight
  std::vector<Joints> joints_;   // sets of four
};

}  // namespace qtrace::gltf
