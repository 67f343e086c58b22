#include "engine/gltf/primitive.h"

namespace qtrace::gltf {
namespace {

using Corners = std::array<std::size_t, 3>;

// The orders that glTF 2.0 gives in section 3.7.2.1, which keep strips and fans facing one way.
Corners triangle_corners(int mode, std::size_t i) {
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {i + 1, i + 2, 0};
  if (mode == TINYGLTF_MODE_TRIANGLES) return {3 * i, 3 * i + 1, 3 * i + 2};
  return i % 2 == 0 ? Corners{i, i + 1, i + 2} : Corners{i, i + 2, i + 1};
}

void check_corner_count(const Source& source, const std::string& place, int mode, std::size_t corners) {
  const bool is_list = mode == TINYGLTF_MODE_TRIANGLES;
  source.check(corners >= 3 && (!is_list || corners % 3 == 0), "{} has {} {}; {} would be right", place,
               corners, corners == 1 ? "corner" : "corners", is_list ? "a multiple of 3" : "3 or more");
}

void check_same_count(const Source& source, const AccessorView& attribute, const AccessorView& positions) {
  source.check(attribute.size() == positions.size(),
               "{} has a count of {}; {}, as POSITION has, would be right", attribute.role(),
               attribute.size(), positions.size());
}

}  // namespace

Primitive::Primitive(const Source& source, std::size_t mesh_index, std::size_t primitive_index) {
  const tinygltf::Mesh& mesh = source.model.meshes[mesh_index];
  const tinygltf::Primitive& file = mesh.primitives[primitive_index];
  place_ = fmt::format("{} primitive {}", label("mesh", mesh_index, mesh.name), primitive_index);
  mode_ = file.mode;
  material_ = file.material;
  if (!is_surface()) return;
  const auto open = [&](const char* name, const Layout& layout, std::optional<AccessorView>& view) {
    const auto attribute = file.attributes.find(name);
    if (attribute == file.attributes.end()) return;
    view.emplace(source, attribute->second, layout, fmt::format("{} {}", place_, name));
  };
  open("POSITION", kPositionLayout, positions_);
  open("NORMAL", kNormalLayout, normals_);
  open("TEXCOORD_0", kUvLayout, uv_);
  source.check(positions_.has_value(), "{} has no POSITION; {} would be right", place_, kPositionLayout.text);
  if (normals_) check_same_count(source, *normals_, *positions_);
  if (uv_) check_same_count(source, *uv_, *positions_);
  if (file.indices >= 0) indices_.emplace(source, file.indices, kIndexLayout, place_ + " indices");
  check_corner_count(source, place_, mode_, corner_count());
}

bool Primitive::is_surface() const { return mode_ >= TINYGLTF_MODE_TRIANGLES; }

std::size_t Primitive::corner_count() const { return indices_ ? indices_->size() : positions_->size(); }

std::size_t Primitive::triangle_count() const {
  if (!is_surface()) return 0;
  return mode_ == TINYGLTF_MODE_TRIANGLES ? corner_count() / 3 : corner_count() - 2;
}

std::uint32_t Primitive::vertex(const Source& source, std::size_t corner) const {
  if (!indices_) return static_cast<std::uint32_t>(corner);
  const std::uint32_t vertex = indices_->index(corner);
  if (vertex == indices_->restart_value()) {
    source.fail("{}: element {} is {}, the primitive restart value, which glTF forbids", indices_->role(),
                corner, vertex);
  }
  if (vertex >= positions_->size()) {
    source.fail("{}: element {} is {}; an index below {}, the number of vertices, would be right",
                indices_->role(), corner, vertex, positions_->size());
  }
  return vertex;
}

std::array<std::uint32_t, 3> Primitive::triangle(const Source& source, std::size_t i) const {
  const Corners corners = triangle_corners(mode_, i);
  return {vertex(source, corners[0]), vertex(source, corners[1]), vertex(source, corners[2])};
}

glm::vec3 Primitive::position(const Source& source, std::uint32_t vertex) const {
  return positions_->vec3(source, vertex);
}

glm::vec3 Primitive::normal(const Source& source, std::uint32_t vertex) const {
  return normals_->vec3(source, vertex);
}

glm::vec2 Primitive::uv(const Source& source, std::uint32_t vertex) const {
  return uv_->vec2(source, vertex);
}

}  // namespace qtrace::gltf
