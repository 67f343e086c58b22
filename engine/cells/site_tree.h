// Sites in the order of a k-d tree that is searched without a stack: Wald 2022, "A Stack-Free Traversal
// Algorithm for Left-Balanced k-d Trees" (arXiv:2210.12859).
#pragma once

#include "engine/cells/sites.h"

#include <cstdint>
#include <vector>

namespace qtrace {

// What a node is split by: 0, 1, 2: x, y, z of its position; 3, 4, 5: of its normal.
using SplitDimension = std::uint32_t;
inline constexpr SplitDimension kFirstNormalDimension = 3;

inline float coordinate(const CellSite& site, SplitDimension k) {
  return k < kFirstNormalDimension ? site.position[static_cast<int>(k)]
                                   : site.normal[static_cast<int>(k - kFirstNormalDimension)];
}

// Puts the sites of every object into the order of its tree: a node is a site, the children of node i of an
// object are 2i + 1 and 2i + 2, and only the last level has gaps, at its right end. No coordinate of the left
// subtree is above its node's, none of the right one below. Returns every site's dimension.
//
// Sites are told apart by normal first, as long as their normals differ by more than `normal_threshold` lets a
// search reach: a site that serves a normal n has |n' - n|^2 < 2 - 2 threshold.
std::vector<SplitDimension> order_as_trees(CellSites& cells, double normal_threshold);

}  // namespace qtrace
