// A hierarchy with links both ways, for changes.
#pragma once

#include "engine/accel/bounds.h"
#include "engine/accel/bvh.h"

#include <array>

namespace qtrace {

// A subtree's new place: in an inner node of its own beside another one.
struct SubtreeMove {
  std::uint32_t node = kNoNode;
  std::uint32_t beside = kNoNode;  // kNoNode: it is best where it is
  float gain = 0;                  // surface that all boxes lose together
};

// Nodes keep their numbers, those of the Bvh that they come from, while they change places.
class BvhTree {
 public:
  explicit BvhTree(const Bvh& bvh);

  std::size_t size() const { return nodes_.size(); }

  // Nodes that can move, at most `count`, those of the largest boxes, from the largest.
  std::vector<std::uint32_t> largest(std::size_t count) const;

  // Branch and bound through the whole tree.
  SubtreeMove best_move(std::uint32_t node) const;

  // Whether it is still possible after other moves; false too where it shares a node with one since
  // forget_moves().
  bool can_apply(const SubtreeMove& move) const;
  void apply(const SubtreeMove& move);
  void forget_moves() { is_moved_.assign(nodes_.size(), false); }

  // Nodes in preorder and triangles leaf by leaf, the child of the smaller box first. Leaves the Bvh alone
  // and returns false where a leaf lies deeper than kMaxBvhDepth.
  bool store(Bvh& bvh) const;

 private:
  struct Node {
    Bounds box;
    std::uint32_t parent = kNoNode;
    std::array<std::uint32_t, 2> children{kNoNode, kNoNode};  // of inner nodes
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  std::uint32_t sibling(std::uint32_t node) const;
  std::array<std::uint32_t, 5> changed_by(const SubtreeMove& move) const;
  void search_below(std::uint32_t start, float freed, SubtreeMove& best) const;
  void replace_child(std::uint32_t parent, std::uint32_t from, std::uint32_t to);
  void refit(std::uint32_t node);  // and all above it

  std::vector<std::uint32_t> order_;  // of the triangles, as they were
  std::vector<Node> nodes_;
  std::vector<bool> is_moved_;
};

}  // namespace qtrace
