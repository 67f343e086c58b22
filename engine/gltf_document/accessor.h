// Checked, typed reads of vertex attributes and indices.
#pragma once

#include "engine/gltf_document/source.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace qtrace::gltf {

// Of an accessor: integers may stand for themselves or, normalized, for fractions.
struct Component {
  int type;
  bool is_normalized;
  bool operator==(const Component&) const = default;
};

// What an accessor must hold for its role.
struct Layout {
  int type;
  std::span<const Component> components;
  std::string_view text;  // for messages
};

// With those of KHR_mesh_quantization.
extern const Layout kPositionLayout;
extern const Layout kNormalLayout;
extern const Layout kUvLayout;        // TEXCOORD_0 and TEXCOORD_1
extern const Layout kTangentLayout;   // TANGENT: a direction and 1 or -1
extern const Layout kColor3Layout;    // COLOR_0 without opacity
extern const Layout kColor4Layout;    // COLOR_0
extern const Layout kIndexLayout;     // indices
extern const Layout kRotationLayout;  // unit quaternions x, y, z, w
extern const Layout kJointsLayout;    // JOINTS_0 and further sets
extern const Layout kWeightsLayout;   // WEIGHTS_0 and further sets
extern const Layout kMatrixLayout;    // inverse bind matrices

// Elements inside their buffer. Data need not be aligned, so each read copies.
class AccessorView {
 public:
  // `role` is what messages call it, such as "mesh 'teapot' primitive 0 NORMAL".
  AccessorView(const Source& source, int accessor, const Layout& layout, const std::string& role);

  std::size_t size() const { return count_; }
  glm::vec3 vec3(const Source& source, std::size_t i) const;  // Error unless finite
  glm::vec2 vec2(const Source& source, std::size_t i) const;  // Error unless finite
  glm::vec4 vec4(const Source& source, std::size_t i) const;  // Error unless finite
  glm::mat4 mat4(const Source& source, std::size_t i) const;  // Error unless finite
  std::uint32_t index(std::size_t i) const;
  std::uint32_t restart_value() const;  // the index that would restart a strip, which glTF forbids
  const std::string& role() const { return role_; }

 private:
  template <class T>
  T component(std::size_t i, std::size_t component) const;
  template <class T>
  float fraction(std::size_t i, std::size_t component) const;
  float number(std::size_t i, std::size_t component) const;
  // Fills `values`; Error unless all are finite.
  void numbers(const Source& source, std::size_t i, std::span<float> values) const;

  std::string role_;
  const unsigned char* data_ = nullptr;
  std::size_t stride_ = 0;
  std::size_t count_ = 0;
  int component_type_ = 0;
  bool is_normalized_ = false;
};

}  // namespace qtrace::gltf
