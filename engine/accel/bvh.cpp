#include "engine/accel/bvh.h"

#include "engine/core/check.h"

#include <glm/common.hpp>

#include <algorithm>
#include <limits>
#include <span>

namespace qtrace {
namespace {

struct Bounds {
  glm::vec3 lo{std::numeric_limits<float>::max()};
  glm::vec3 hi{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
};

glm::vec3 centre(const Triangle& t) {
  // Halved first: the sum of two large coordinates could overflow.
  const glm::vec3 lo = glm::min(t.position[0], glm::min(t.position[1], t.position[2]));
  const glm::vec3 hi = glm::max(t.position[0], glm::max(t.position[1], t.position[2]));
  return lo * 0.5F + hi * 0.5F;
}

int longest_axis(const Bounds& b) {
  const glm::vec3 size = b.hi - b.lo;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

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
    const Bounds bounds = bounds_of(first, count);
    bvh_.nodes.push_back({bounds.lo, bounds.hi, miss, first, count});
    if (count <= leaf_size_) return;
    const std::uint32_t left = count / 2;
    split(first, left, count, longest_axis(bounds));
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

  Bounds bounds_of(std::uint32_t first, std::uint32_t count) const {
    Bounds bounds;
    for (const std::uint32_t i : std::span(bvh_.order).subspan(first, count)) {
      for (const glm::vec3& p : scene_.triangles[i].position) bounds.add(p);
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
  check(leaf_size >= 1 && leaf_size <= 15, "BVH leaf size {} is outside 1..15", leaf_size);
  check(!scene.triangles.empty(), "scene {} has no triangles: there is nothing to render", scene.name);
  return Builder(scene, leaf_size).take();
}

}  // namespace qtrace
