// The node hierarchy, flattened.
#pragma once

#include "engine/gltf/source.h"
#include "engine/scene/view.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <vector>

namespace qtrace::gltf {

struct PlacedNode {
  std::size_t index;    // into Model::nodes
  glm::dmat4 to_world;  // its elements are finite as floats too
};

// The nodes of the scene that `scene` names, else of the default scene, else of the first, else all; parents
// before children, siblings in order. Error where the nodes do not form trees. Warnings name rotations that
// are not quite of length 1, and nodes that the scene lists although it lists an ancestor.
std::vector<PlacedNode> place_nodes(Source& source, const NameOrIndex& scene);

std::string node_label(const Source& source, std::size_t index);

}  // namespace qtrace::gltf
