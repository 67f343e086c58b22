// Which of many boxes overlap one.
#pragma once

#include "engine/scene/scene.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace qtrace::gltf {

struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  bool overlaps(const Box& other) const {
    return low.x <= other.high.x && low.y <= other.high.y && low.z <= other.high.z && other.low.x <= high.x &&
           other.low.y <= high.y && other.low.z <= high.z;
  }
};

// Of a triangle, and `margin` around it.
inline Box box_of(const Triangle& triangle, float margin) {
  Box box;
  for (const glm::vec3& p : triangle.position) box.add({p - margin, p + margin});
  return box;
}

// Split at the median of the longest axis, down to a few boxes.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    if (!order_.empty()) build(0, order_.size());
  }

  // Calls `found` with the index of each box that overlaps `wanted`.
  template <class Found>
  void visit(const Box& wanted, Found found) const {
    any(wanted, [&found](std::size_t i) {
      found(i);
      return false;
    });
  }

  // Whether `is_wanted` holds for the index of one that does; the others are left out then.
  template <class IsWanted>
  bool any(const Box& wanted, IsWanted is_wanted) const {
    return !nodes_.empty() && any(0, wanted, is_wanted);
  }

 private:
  struct Node {
    Box box;
    std::size_t first = 0, count = 0;  // of order_, in a leaf
    std::size_t right = 0;             // the other child follows its parent
  };
  static constexpr std::size_t kLeaf = 4;

  std::size_t build(std::size_t first, std::size_t last) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    Box box;
    for (std::size_t i = first; i < last; ++i) box.add(boxes_[order_[i]]);
    nodes_[index].box = box;
    if (last - first <= kLeaf) {
      nodes_[index].first = first;
      nodes_[index].count = last - first;
      return index;
    }
    const glm::vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = (first + last) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [&](std::size_t a, std::size_t b) {
      return boxes_[a].low[axis] + boxes_[a].high[axis] < boxes_[b].low[axis] + boxes_[b].high[axis];
    });
    build(first, middle);
    const std::size_t right = build(middle, last);
    nodes_[index].right = right;
    return index;
  }

  template <class IsWanted>
  bool any(std::size_t index, const Box& wanted, IsWanted& is_wanted) const {
    const Node& node = nodes_[index];
    if (!node.box.overlaps(wanted)) return false;
    if (node.count == 0) return any(index + 1, wanted, is_wanted) || any(node.right, wanted, is_wanted);
    for (std::size_t i = node.first; i < node.first + node.count; ++i) {
      if (boxes_[order_[i]].overlaps(wanted) && is_wanted(order_[i])) return true;
    }
    return false;
  }

  std::vector<Box> boxes_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace qtrace::gltf
