#include "engine/accel/median_bvh.h"
#include "engine/accel/bvh_input.h"

#include "engine/accel/bounds.h"

#include <algorithm>
#include <span>

namespace qtrace {
namespace {

glm::vec3 centre(const Triangle& t) { return bounds_of(t).centre(); }

class Builder {
 public:
  Builder(const Scene& scene, std::uint32_t leaf_size) : scene_(scene), leaf_size_(leaf_size) {
    const auto triangles = static_cast<std::uint32_t>(scene.triangles.size());
    bvh_.order.resize(triangles);
    for (std::uint32_t i = 0; i < triangles; ++i) bvh_.order[i] = i;
    build(0, triangles, kNoNode);
  }

  Bvh take() { return std::move(bvh_); }

 private:
  // Median splits halve the count, so the depth is at most log2 of the triangles.
  void build(std::uint32_t first, std::uint32_t count, std::uint32_t miss) {
    const std::size_t index = bvh_.nodes.size();
    const Bounds bounds = bounds_of_range(first, count);
    bvh_.nodes.push_back({bounds.lo, bounds.hi, miss, first, count});
    if (count <= leaf_size_) return;
    const std::uint32_t left = count / 2;
    split(first, left, count, bounds.longest_axis());
    bvh_.nodes[index].count = 0;
    const std::size_t left_index = bvh_.nodes.size();
    build(first, left, kNoNode);
    const auto right_index = static_cast<std::uint32_t>(bvh_.nodes.size());
    // Every way out of the left subtree leads to the right one.
    for (std::size_t i = left_index; i < right_index; ++i) {
      if (bvh_.nodes[i].miss == kNoNode) bvh_.nodes[i].miss = right_index;
    }
    build(first + left, count - left, miss);
  }

  Bounds bounds_of_range(std::uint32_t first, std::uint32_t count) const {
    Bounds bounds;
    for (const std::uint32_t i : std::span(bvh_.order).subspan(first, count)) {
      bounds.add(bounds_of(scene_.triangles[i]));
    }
    return bounds;
  }

  void split(std::uint32_t first, std::uint32_t left, std::uint32_t count, int axis) {
    const auto begin = bvh_.order.begin() + first;
    std::nth_element(begin, begin + left, begin + count, [&](std::uint32_t a, std::uint32_t b) {
      const float ca = centre(scene_.triangles[a])[axis];
      const float cb = centre(scene_.triangles[b])[axis];
      return ca != cb ? ca < cb : a < b;
    });
  }

  const Scene& scene_;
  std::uint32_t leaf_size_;
  Bvh bvh_;
};

}  // namespace

Bvh build_median_bvh(const Scene& scene, std::uint32_t leaf_size) {
  check_leaf_size(leaf_size);
  if (scene.triangles.empty()) return empty_bvh(BvhKind::threaded);
  return Builder(scene, leaf_size).take();
}

}  // namespace qtrace
