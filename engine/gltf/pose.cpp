#include "engine/gltf/pose.h"

#include <algorithm>

namespace qtrace::gltf {
namespace {

std::vector<double> morph_weights(const tinygltf::Node& node, const tinygltf::Mesh& mesh) {
  const std::vector<double>& weights = node.weights.empty() ? mesh.weights : node.weights;
  const bool are_all_zero = std::ranges::all_of(weights, [](double weight) { return weight == 0; });
  return are_all_zero ? std::vector<double>() : weights;
}

std::vector<glm::dmat4> joint_transforms(const Source& source, const tinygltf::Skin& skin,
                                         const std::string& name, const NodeTransforms& transforms) {
  std::optional<AccessorView> inverse_bind;
  if (skin.inverseBindMatrices >= 0) {
    inverse_bind.emplace(source, skin.inverseBindMatrices, kMatrixLayout, name + " inverseBindMatrices");
    source.check(inverse_bind->size() >= skin.joints.size(),
                 "{} has a count of {}; {}, one for each joint, would be right", inverse_bind->role(),
                 inverse_bind->size(), skin.joints.size());
  }
  source.check(!skin.joints.empty(), "{} has no joints; one at least would be right", name);
  std::vector<glm::dmat4> joints;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const auto node = static_cast<std::size_t>(skin.joints[i]);
    const glm::dmat4* to_world = transforms.find(node);
    source.check(to_world != nullptr,
                 "{}: its joint {} is {}, which the scene does not have; one of its nodes would be right",
                 name, i, node_label(source, node));
    joints.push_back(inverse_bind ? *to_world * glm::dmat4(inverse_bind->mat4(source, i)) : *to_world);
  }
  return joints;
}

}  // namespace

NodeTransforms::NodeTransforms(const Source& source, const std::vector<PlacedNode>& nodes)
    : to_world_(source.model.nodes.size()) {
  for (const PlacedNode& node : nodes) {
    if (!node.instance) to_world_[node.index] = node.to_world;
  }
}

const glm::dmat4* NodeTransforms::find(std::size_t node) const {
  return to_world_[node] ? &*to_world_[node] : nullptr;
}

Pose::Pose(const Source& source, const PlacedNode& node, const NodeTransforms& transforms)
    : source_(source), mesh_(static_cast<std::size_t>(node.mesh)), to_world_(node.to_world) {
  const tinygltf::Node& file = source.model.nodes[node.index];
  weights_ = morph_weights(file, source.model.meshes[mesh_]);
  if (file.skin < 0) return;
  const auto skin = static_cast<std::size_t>(file.skin);
  skin_ = label("skin", skin, source.model.skins[skin].name);
  joints_ = joint_transforms(source, source.model.skins[skin], skin_, transforms);
}

glm::dmat4 Pose::to_world(const Primitive& primitive, std::uint32_t vertex) const {
  if (is_rigid(primitive)) return to_world_;
  glm::dmat4 sum(0.0);
  for (const Primitive::Influence& influence : primitive.influences(source_, vertex)) {
    source_.check(influence.joint < joints_.size(),
                  "{}: vertex {} follows joint {} of {}; one below {} would be right", primitive.place(),
                  vertex, influence.joint, skin_, joints_.size());
    sum += influence.weight * joints_[influence.joint];
  }
  return sum;
}

}  // namespace qtrace::gltf
