// Nodes that show their mesh many times (EXT_mesh_gpu_instancing).
#pragma once

#include "engine/gltf/node.h"

#include <vector>

namespace qtrace::gltf {

// Each node that asks for instances shows its mesh no longer itself, and is followed by one for each of them.
// Error for attributes of different lengths, and for more than `most` instances.
std::vector<PlacedNode> with_instances(Source& source, const std::vector<PlacedNode>& nodes,
                                       std::size_t most);

}  // namespace qtrace::gltf
