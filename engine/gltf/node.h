// The node hierarchy, flattened.
#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/view.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace qtrace::gltf {

struct PlacedNode {
  std::size_t index;                      // into Model::nodes
  glm::dmat4 to_world;                    // its elements are finite as floats too
  int mesh = -1;                          // into Model::meshes, that is seen; -1: none
  std::optional<std::size_t> instance{};  // which of several that the node asks for (instances.h)
  int light = -1;                         // into Model::lights, that is shown; -1: none
};

// The nodes of the scene that `scene` names, else of the default scene, else of the first, else all; parents
// before children, siblings in order. Meshes and lights of hidden nodes (KHR_node_visibility) and of what
// hangs below them are not seen. Error where the nodes do not form trees. Warnings name rotations that are
// not quite of length 1, and nodes that the scene lists although it lists an ancestor.
std::vector<PlacedNode> place_nodes(Source& source, const NameOrIndex& scene);

// Whether all elements are finite as floats.
bool fits_float(const glm::dmat4& matrix);

std::string node_label(const Source& source, std::size_t index);

}  // namespace qtrace::gltf
