// How a node's mesh stands in the world: its morph targets, the joints of its skin, its transform.
#pragma once

#include "engine/gltf/node.h"
#include "engine/gltf/primitive.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace qtrace::gltf {

// By their indices into Model::nodes: where the placed ones stand.
class NodeTransforms {
 public:
  NodeTransforms(const Source& source, const std::vector<PlacedNode>& nodes);
  const glm::dmat4* find(std::size_t node) const;  // null where it is not placed

 private:
  std::vector<std::optional<glm::dmat4>> to_world_;
};

class Pose {
 public:
  // Of a node that shows a mesh. Error where its skin is malformed or has joints that are not placed.
  Pose(const Source& source, const PlacedNode& node, const NodeTransforms& transforms);

  std::size_t mesh() const { return mesh_; }
  Primitive primitive(std::size_t i, const Extras& extras = {}) const {
    return {source_, mesh_, i, weights_, extras};
  }

  // Whether all of its vertices move by to_world() alone. Of a skinned one each has a transform of its own,
  // and the node's does not count (glTF 2.0, section 3.7.3.3).
  bool is_rigid(const Primitive& primitive) const { return joints_.empty() || !primitive.has_joints(); }
  const glm::dmat4& to_world() const { return to_world_; }
  glm::dmat4 to_world(const Primitive& primitive, std::uint32_t vertex) const;

 private:
  const Source& source_;
  std::size_t mesh_;
  std::vector<double> weights_;  // of morph targets
  glm::dmat4 to_world_;
  std::vector<glm::dmat4> joints_;  // from the mesh in its bind pose; none without a skin
  std::string skin_;                // what messages call it
};

}  // namespace qtrace::gltf
