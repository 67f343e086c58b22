// Scenes far from their origin.
#pragma once

#include "engine/gltf/node.h"

#include <glm/vec3.hpp>

#include <vector>

namespace qtrace::gltf {

// Where a scene lies so far from the origin that single precision would lose its details, moves the nodes
// about the origin and returns by how much; zero for all other scenes, which stay as they are. Their
// positions are still in double precision here, so that nothing is lost.
glm::dvec3 centre_nodes(const Source& source, std::vector<PlacedNode>& nodes);

}  // namespace qtrace::gltf
