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

}  // namespace

Primitive::Primitive(const Source& source, std::size_t mesh_index, std::size_t primitive_index,
                     const std::vector<double>& weights, const Extras& extras) {
  const tinygltf::Mesh& mesh = source.model.meshes[mesh_index];
  const tinygltf::Primitive& file = mesh.primitives[primitive_index];
  place_ = fmt::format("{} primitive {}", label("mesh", mesh_index, mesh.name), primitive_index);
  mode_ = file.mode;
  material_ = file.material;
  if (mode_ < TINYGLTF_MODE_TRIANGLES || !file.attributes.contains("POSITION")) return;
  const auto open = [&](const char* name, const Layout& layout, std::optional<AccessorView>& view) {
    const auto attribute = file.attributes.find(name);
    if (attribute == file.attributes.end()) return;
    view.emplace(source, attribute->second, layout, fmt::format("{} {}", place_, name));
  };
  open("POSITION", kPositionLayout, positions_);
  open("NORMAL", kNormalLayout, normals_);
  open("TEXCOORD_0", kUvLayout, uv_);
  if (normals_) check_count(source, *normals_);
  if (uv_) check_count(source, *uv_);
  open_extras(source, file, extras);
  open_targets(source, file, weights);
  open_joints(source, file);
  if (file.indices >= 0) indices_.emplace(source, file.indices, kIndexLayout, place_ + " indices");
  check_corner_count(source, place_, mode_, corner_count());
}

void Primitive::open_extras(const Source& source, const tinygltf::Primitive& file, const Extras& extras) {
  const auto open = [&](bool is_wanted, const char* name, const Layout& layout,
                        std::optional<AccessorView>& view) {
    const auto attribute = file.attributes.find(name);
    if (!is_wanted || attribute == file.attributes.end()) return;
    view.emplace(source, attribute->second, layout, fmt::format("{} {}", place_, name));
    check_count(source, *view);
  };
  open(extras.uv1, "TEXCOORD_1", kUvLayout, uv1_);
  open(extras.tangents, "TANGENT", kTangentLayout, tangents_);
  const auto color = file.attributes.find("COLOR_0");
  if (color == file.attributes.end()) return;
  const auto accessor = static_cast<std::size_t>(color->second);
  has_opacity_ = source.model.accessors.at(accessor).type != TINYGLTF_TYPE_VEC3;
  open(extras.colors, "COLOR_0", has_opacity_ ? kColor4Layout : kColor3Layout, colors_);
}

void Primitive::check_count(const Source& source, const AccessorView& attribute) const {
  source.check(attribute.size() == positions_->size(),
               "{} has a count of {}; {}, as POSITION has, would be right", attribute.role(),
               attribute.size(), positions_->size());
}

void Primitive::open_targets(const Source& source, const tinygltf::Primitive& file,
                             const std::vector<double>& weights) {
  if (weights.empty() || file.targets.empty()) return;
  source.check(weights.size() == file.targets.size(),
               "{} has {} morph targets and {} weights; as many would be right", place_, file.targets.size(),
               weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    Target& target = targets_.emplace_back();
    target.weight = weights[i];
    const auto open = [&](const char* name, const Layout& layout, std::optional<AccessorView>& view) {
      const auto attribute = file.targets[i].find(name);
      if (attribute == file.targets[i].end()) return;
      view.emplace(source, attribute->second, layout, fmt::format("{} target {} {}", place_, i, name));
      check_count(source, *view);
    };
    open("POSITION", kPositionLayout, target.positions);
    open("NORMAL", kNormalLayout, target.normals);
    if (tangents_) open("TANGENT", kNormalLayout, target.tangents);
  }
}

void Primitive::open_joints(const Source& source, const tinygltf::Primitive& file) {
  for (int set = 0;; ++set) {
    const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
    const auto joint = file.attributes.find(joints), weight = file.attributes.find(weights);
    if (joint == file.attributes.end() && weight == file.attributes.end()) return;
    source.check(joint != file.attributes.end() && weight != file.attributes.end(),
                 "{} has {} alone; {} and {} belong together", place_,
                 joint == file.attributes.end() ? weights : joints, joints, weights);
    joints_.push_back(
        {AccessorView(source, joint->second, kJointsLayout, fmt::format("{} {}", place_, joints)),
         AccessorView(source, weight->second, kWeightsLayout, fmt::format("{} {}", place_, weights))});
    check_count(source, joints_.back().indices);
    check_count(source, joints_.back().weights);
  }
}

std::vector<Primitive::Influence> Primitive::influences(const Source& source, std::uint32_t vertex) const {
  std::vector<Influence> found;
  double sum = 0;
  for (const Joints& set : joints_) {
    const glm::vec4 joints = set.indices.vec4(source, vertex), weights = set.weights.vec4(source, vertex);
    for (int i = 0; i < 4; ++i) {
      if (weights[i] == 0) continue;
      source.check(weights[i] > 0, "{}: element {} has a weight of {}; 0 or more would be right",
                   set.weights.role(), vertex, weights[i]);
      found.push_back({static_cast<std::uint32_t>(joints[i]), static_cast<double>(weights[i])});
      sum += found.back().weight;
    }
  }
  source.check(sum > 0, "{}: vertex {} follows no joint; weights that add up to 1 would be right", place_,
               vertex);
  for (Influence& influence : found) influence.weight /= sum;
  return found;
}

bool Primitive::is_surface() const { return positions_.has_value(); }

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
  const glm::vec3 base = positions_->vec3(source, vertex);
  if (targets_.empty()) return base;
  glm::dvec3 sum(base);
  for (const Target& target : targets_) {
    if (target.positions) sum += target.weight * glm::dvec3(target.positions->vec3(source, vertex));
  }
  return sum;
}

glm::vec3 Primitive::normal(const Source& source, std::uint32_t vertex) const {
  const glm::vec3 base = normals_->vec3(source, vertex);
  if (targets_.empty()) return base;
  glm::dvec3 sum(base);
  for (const Target& target : targets_) {
    if (target.normals) sum += target.weight * glm::dvec3(target.normals->vec3(source, vertex));
  }
  return sum;
}

glm::vec2 Primitive::uv(const Source& source, std::uint32_t vertex) const {
  return uv_->vec2(source, vertex);
}

glm::vec2 Primitive::uv1(const Source& source, std::uint32_t vertex) const {
  return uv1_->vec2(source, vertex);
}

// Morph targets turn tangents, and do not change their handedness (glTF 2.0, section 3.7.2.2).
glm::vec4 Primitive::tangent(const Source& source, std::uint32_t vertex) const {
  const glm::vec4 base = tangents_->vec4(source, vertex);
  glm::dvec3 sum(base);
  for (const Target& target : targets_) {
    if (target.tangents) sum += target.weight * glm::dvec3(target.tangents->vec3(source, vertex));
  }
  return {glm::vec3(sum), base.w};
}

glm::vec4 Primitive::color(const Source& source, std::uint32_t vertex) const {
  return has_opacity_ ? colors_->vec4(source, vertex) : glm::vec4(colors_->vec3(source, vertex), 1);
}

}  // namespace qtrace::gltf
