// Sites in the order of a k-d tree that is searched without a stack: Wald 2022, "A Stack-Free Traversal
// Algorithm for Left-Balanced k-d Trees" (arXiv:2210.12859).
#pragma once

#include "engine/cells/sites.h"

#include <glm/vec3.hpp>

#include <vector>

namespace qtrace {

struct SiteNode {
  int axis = 0;               // of positions, by which the subtrees are told apart
  glm::vec3 lo_normal{0.0F};  // bounds of the normals of the node and what is below it
  glm::vec3 hi_normal{0.0F};
};

// Puts the sites of every object into the order of its tree: a node is a site, the children of node i of an
// object are 2i + 1 and 2i + 2, and only the last level has gaps, at its right end. No site of the left
// subtree lies above its node along the node's axis, none of the right one below. Returns the nodes, in that
// order.
//
// Positions alone split: neighbours on a surface nearly always have like normals, so that the bounds tell
// early where no site can serve. Splitting by normals as well takes several times the steps.
std::vector<SiteNode> order_as_trees(CellSites& cells);

}  // namespace qtrace
