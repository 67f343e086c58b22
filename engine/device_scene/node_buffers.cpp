#include "engine/device_scene/node_buffers.h"

#include <bit>

namespace qtrace::gpu {
namespace {

constexpr BufferUse kUse = only_fetched(Texels::uint4);

float as_float(uint bits) { return std::bit_cast<float>(bits); }

std::vector<Node> pack_linked_nodes(const Bvh& bvh) {
  std::vector<Node> nodes;
  nodes.reserve(bvh.nodes.size());
  for (const BvhNode& node : bvh.nodes) {
    const uint leaf = node.count > 0 ? (node.first << LEAF_BITS) | node.count : 0;
    nodes.push_back({vec4(node.lo, as_float(leaf)), vec4(node.hi, as_float(node.miss))});
  }
  return nodes;
}

Buffer upload(const Bvh& bvh, const WideNodes& wide) {
  const std::string name = "BVH nodes";
  return bvh.kind == BvhKind::threaded ? Buffer(name, pack_linked_nodes(bvh), kUse)
                                       : Buffer(name, wide.nodes, kUse);
}

}  // namespace

NodeBuffers::NodeBuffers(const Bvh& bvh, const glm::vec3& eye)
    : NodeBuffers(bvh, bvh.kind == BvhKind::sah ? pack_wide_nodes(bvh, eye) : WideNodes{}) {}

NodeBuffers::NodeBuffers(const Bvh& bvh, const WideNodes& wide)
    : nodes_(upload(bvh, wide)), grid_("grid of BVH nodes", std::span(&wide.grid, 1)) {}

void NodeBuffers::bind() const {
  nodes_.bind_fetched(UNIT_NODES);
  grid_.bind_uniform(BINDING_NODE_GRID);
}

}  // namespace qtrace::gpu
