// Bounding volume hierarchies: the same nodes, however they were built.
#pragma once

#include "engine/core/settings.h"
#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace qtrace {

inline constexpr std::uint32_t kNoNode = 0xffffffff;
inline constexpr std::uint32_t kNoTriangle = 0xffffffff;
// Deepest leaf, the root being at 0: shaders keep a stack of as many links.
inline constexpr int kMaxBvhDepth = 62;

// Nodes stand in preorder: the hit link of an inner node, its first child, is the next node. Its second child
// is the first one's miss link. A leaf goes on at its miss link either way.
struct BvhNode {
  glm::vec3 lo{0.0F};
  glm::vec3 hi{0.0F};
  std::uint32_t miss = kNoNode;
  std::uint32_t first = 0;  // leaf: its triangles are order[first .. first + count)
  std::uint32_t count = 0;  // 0 for inner nodes
};

struct Bvh {
  BvhKind kind = BvhKind::threaded;  // how shaders are to walk it
  std::vector<BvhNode> nodes;
  // Triangle indices of the scene, each once, leaf by leaf; kNoTriangle alone where it has none.
  std::vector<std::uint32_t> order;
};

}  // namespace qtrace
