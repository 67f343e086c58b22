#include "engine/accel/bvh_input.h"

#include "engine/core/check.h"

namespace qtrace {

void check_leaf_size(std::uint32_t leaf_size) {
  check(leaf_size >= 1 && leaf_size <= 15, "BVH leaf size {} is outside 1..15", leaf_size);
}

// A count of 0 would make it an inner node.
Bvh empty_bvh(BvhKind kind) {
  BvhNode leaf;
  leaf.count = 1;
  return {kind, {leaf}, {kNoTriangle}};
}

}  // namespace qtrace
