// The hierarchy as shaders/geometry/wide_nodes.glsl has it.
#pragma once

#include "engine/accel/bvh.h"
#include "engine/gpu/structs.h"

#include <vector>

namespace qtrace::gpu {

struct WideNodes {
  NodeGrid grid{};
  std::vector<WideNode> nodes;
};

// `eye`: where rays start that do not start on a surface. Throws Error where there are more triangles than
// links can tell apart (2^27).
WideNodes pack_wide_nodes(const Bvh& bvh, const glm::vec3& eye);

}  // namespace qtrace::gpu
