#include "engine/accel/bvh_tree.h"

#include <algorithm>
#include <utility>

namespace qtrace {
namespace {

using Index = std::uint32_t;

Bounds united(Bounds a, const Bounds& b) {
  a.add(b);
  return a;
}

// Of nodes in preorder: the next one that is no deeper.
void link_misses(std::vector<BvhNode>& nodes, const std::vector<int>& depths) {
  std::array<Index, kMaxBvhDepth + 1> next{};
  next.fill(kNoNode);
  for (Index i = static_cast<Index>(nodes.size()); i-- > 0;) {
    const auto end = next.begin() + depths[i] + 1;
    nodes[i].miss = *std::min_element(next.begin(), end);
    *(end - 1) = i;
  }
}

}  // namespace

BvhTree::BvhTree(const Bvh& bvh)
    : order_(bvh.order), nodes_(bvh.nodes.size()), is_moved_(bvh.nodes.size(), false) {
  for (Index i = 0; i < nodes_.size(); ++i) {
    const BvhNode& from = bvh.nodes[i];
    Node& to = nodes_[i];
    to.box = {from.lo, from.hi};
    to.first = from.first;
    to.count = from.count;
    if (from.count > 0) continue;
    to.children = {i + 1, bvh.nodes[i + 1].miss};
    for (const Index child : to.children) nodes_[child].parent = i;
  }
}

std::vector<Index> BvhTree::largest(std::size_t count) const {
  std::vector<std::pair<float, Index>> all;
  for (Index i = 1; i < nodes_.size(); ++i) {
    if (nodes_[i].parent != 0) all.emplace_back(-half_area(nodes_[i].box), i);
  }
  const auto end = all.begin() + std::min(std::ssize(all), static_cast<std::ptrdiff_t>(count));
  std::partial_sort(all.begin(), end, all.end());
  std::vector<Index> result;
  for (auto entry = all.begin(); entry != end; ++entry) result.push_back(entry->second);
  return result;
}

// Beside every node below `start`. `freed`: surface that boxes lose where the node is taken out.
void BvhTree::search_below(Index start, float freed, SubtreeMove& best) const {
  const Bounds& box = nodes_[best.node].box;
  const float own = half_area(box);
  std::vector<std::pair<float, Index>> open{{freed, start}};
  while (!open.empty()) {
    const auto [most, at] = open.back();
    open.pop_back();
    if (!(most - own > best.gain)) continue;  // not even where its box lies within
    const float gain = most - half_area(united(nodes_[at].box, box));
    if (gain > best.gain) best = {best.node, at, gain};
    if (nodes_[at].count > 0) continue;
    for (const Index child : nodes_[at].children) open.emplace_back(gain + half_area(nodes_[at].box), child);
  }
}

SubtreeMove BvhTree::best_move(Index node) const {
  SubtreeMove best{node, kNoNode, 0};
  Index above = nodes_[node].parent;
  Index start = sibling(node);
  Bounds without = nodes_[start].box;  // the box above, without the node
  float freed = half_area(nodes_[above].box);
  search_below(start, freed, best);
  while (nodes_[above].parent != kNoNode) {
    start = sibling(above);
    above = nodes_[above].parent;
    search_below(start, freed, best);
    without.add(nodes_[start].box);
    freed += half_area(nodes_[above].box) - half_area(without);
  }
  return best;
}

std::array<Index, 5> BvhTree::changed_by(const SubtreeMove& move) const {
  const Index parent = nodes_[move.node].parent;
  return {move.node, parent, sibling(move.node), nodes_[parent].parent, move.beside};
}

bool BvhTree::can_apply(const SubtreeMove& move) const {
  if (std::ranges::any_of(changed_by(move), [&](Index i) { return is_moved_[i]; })) return false;
  Index above = move.beside;
  while (above != kNoNode && above != move.node) above = nodes_[above].parent;
  return above == kNoNode;  // not within itself
}

void BvhTree::apply(const SubtreeMove& move) {
  for (const Index i : changed_by(move)) is_moved_[i] = true;
  const Index parent = nodes_[move.node].parent;
  const Index above = nodes_[parent].parent;
  replace_child(above, parent, sibling(move.node));
  refit(above);
  replace_child(nodes_[move.beside].parent, move.beside, parent);
  nodes_[parent].children = {move.beside, move.node};
  nodes_[move.beside].parent = parent;
  refit(parent);
}

bool BvhTree::store(Bvh& bvh) const {
  Bvh result{bvh.kind, {}, {}};
  result.nodes.reserve(nodes_.size());
  result.order.reserve(order_.size());
  std::vector<int> depths;
  std::vector<std::pair<Index, int>> open{{0, 0}};
  while (!open.empty()) {
    const auto [index, depth] = open.back();
    open.pop_back();
    if (depth > kMaxBvhDepth) return false;
    const Node& node = nodes_[index];
    const auto first = node.count > 0 ? static_cast<Index>(result.order.size()) : 0;
    result.nodes.push_back({node.box.lo, node.box.hi, kNoNode, first, node.count});
    depths.push_back(depth);
    const auto begin = order_.begin() + node.first;
    if (node.count > 0) {
      result.order.insert(result.order.end(), begin, begin + node.count);
      continue;
    }
    auto [a, b] = node.children;
    if (half_area(nodes_[a].box) > half_area(nodes_[b].box)) std::swap(a, b);
    open.emplace_back(b, depth + 1);
    open.emplace_back(a, depth + 1);
  }
  link_misses(result.nodes, depths);
  bvh = std::move(result);
  return true;
}

Index BvhTree::sibling(Index node) const {
  const auto& both = nodes_[nodes_[node].parent].children;
  return both[0] == node ? both[1] : both[0];
}

void BvhTree::replace_child(Index parent, Index from, Index to) {
  auto& both = nodes_[parent].children;
  (both[0] == from ? both[0] : both[1]) = to;
  nodes_[to].parent = parent;
}

void BvhTree::refit(Index node) {
  for (; node != kNoNode; node = nodes_[node].parent) {
    const auto& [a, b] = nodes_[node].children;
    nodes_[node].box = united(nodes_[a].box, nodes_[b].box);
  }
}

}  // namespace qtrace
