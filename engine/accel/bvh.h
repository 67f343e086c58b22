// The report's bounding volume hierarchy: split at the median of the triangles' centres along the longest
// axis, traversed without a stack by hit and miss links (section 4.1).
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace qtrace {

inline constexpr std::uint32_t kNoNode = 0xffffffff;

// Nodes stand in preorder: the hit link of an inner node is the next node. A leaf goes on at its miss link
// either way.
struct BvhNode {
  glm::vec3 lo{0.0F};
  glm::vec3 hi{0.0F};
  std::uint32_t miss = kNoNode;
  std::uint32_t first = 0;  // leaf: its triangles are order[first .. first + count)
  std::uint32_t count = 0;  // 0 for inner nodes
};

struct Bvh {
  std::vector<BvhNode> nodes;
  std::vector<std::uint32_t> order;  // triangle indices of the scene, each once, leaf by leaf
};

// `leaf_size`: most triangles of a leaf, 1..15. Throws Error for a scene without triangles.
Bvh build_median_bvh(const Scene& scene, std::uint32_t leaf_size);

}  // namespace qtrace
