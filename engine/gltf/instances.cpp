#include "engine/gltf/instances.h"

#include "engine/gltf_document/accessor.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <optional>

namespace qtrace::gltf {
namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

// Where the instances of a node stand, seen from the node.
class Instances {
 public:
  Instances(const Source& source, const PlacedNode& node, const tinygltf::Value& attributes)
      : source_(source), place_(fmt::format("{} {}", node_label(source, node.index), kExtension)) {
    open(attributes, "TRANSLATION", kPositionLayout, translations_);
    open(attributes, "ROTATION", kRotationLayout, rotations_);
    open(attributes, "SCALE", kPositionLayout, scales_);
  }

  // Without any of the three, all instances stand where the node does: one is as good as many.
  std::size_t count() const { return count_.value_or(1); }

  glm::dmat4 transform(std::size_t i) const {
    glm::dmat4 result(1.0);
    if (translations_) result = glm::translate(result, glm::dvec3(translations_->vec3(source_, i)));
    if (rotations_) result *= rotation(i);
    if (scales_) result = glm::scale(result, glm::dvec3(scales_->vec3(source_, i)));
    return result;
  }

 private:
  void open(const tinygltf::Value& attributes, const char* name, const Layout& layout,
            std::optional<AccessorView>& view) {
    if (!attributes.Has(name)) return;
    view.emplace(source_, attributes.Get(name).GetNumberAsInt(), layout, fmt::format("{} {}", place_, name));
    source_.check(!count_ || *count_ == view->size(),
                  "{} has a count of {}; {}, as the others have, would be right", view->role(), view->size(),
                  count_.value_or(0));
    count_ = view->size();
  }

  // Integers round a quaternion's length by up to a hundredth.
  glm::dmat4 rotation(std::size_t i) const {
    constexpr double kRounding = 0.02;
    const glm::vec4 file = rotations_->vec4(source_, i);
    const glm::dquat rotation(file.w, file.x, file.y, file.z);
    const double length = glm::length(rotation);
    source_.check(std::abs(length - 1) < kRounding,
                  "{}: element {} has length {}; a unit quaternion would be right", rotations_->role(), i,
                  length);
    return glm::mat4_cast(rotation / length);
  }

  const Source& source_;
  std::string place_;
  std::optional<std::size_t> count_;
  std::optional<AccessorView> translations_, rotations_, scales_;
};

// Joints say where a skinned mesh stands; glTF does not say what instances of one are.
void warn_of_skin(Source& source, const PlacedNode& node) {
  if (source.model.nodes[node.index].skin < 0) return;
  source.warn("{}: its mesh has both a skin and instances of {}; all of these stand where the joints are",
              node_label(source, node.index), kExtension);
}

}  // namespace

std::vector<PlacedNode> with_instances(Source& source, const std::vector<PlacedNode>& nodes,
                                       std::size_t most) {
  std::vector<PlacedNode> result;
  result.reserve(nodes.size());
  std::size_t rest = most;
  for (const PlacedNode& node : nodes) {
    const tinygltf::ExtensionMap& extensions = source.model.nodes[node.index].extensions;
    const auto extension = extensions.find(kExtension);
    result.push_back(node);
    if (node.mesh < 0 || extension == extensions.end()) continue;
    result.back().mesh = -1;
    const Instances instances(source, node, extension->second.Get("attributes"));
    source.check(instances.count() <= rest,
                 "the nodes ask for more than {} instances, which is the most supported", most);
    rest -= instances.count();
    warn_of_skin(source, node);
    for (std::size_t i = 0; i < instances.count(); ++i) {
      result.push_back({node.index, node.to_world * instances.transform(i), node.mesh, i});
      source.check(
          fits_float(result.back().to_world),
          "{}: the world transform of its instance {} overflows; smaller translations and scales would be "
          "right",
          node_label(source, node.index), i);
    }
  }
  return result;
}

}  // namespace qtrace::gltf
