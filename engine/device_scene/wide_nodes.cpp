#include "engine/device_scene/wide_nodes.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace qtrace::gpu {
namespace {

// The walk's stack: its end, and a link for each inner node above a leaf.
static_assert(BVH_DEPTH >= kMaxBvhDepth + 1);

constexpr double kSteps = 65535;
// An axis along which the scene is flatter than this part of its largest extent, or than this part of the way
// to the eye, has the steps of one that is not: else all of the grid's digits were lost to the eye's
// distance.
constexpr float kFlattest = 1e-5F;
constexpr float kNearest = 1e-3F;
// The same where it is flatter than this part of its coordinates: a step is no less than their last digit.
constexpr float kFinest = 65536.0F / 8388608.0F;
// What rounding can move a plane by in the shader's test, in steps, for rays that start within the grid: the
// origin in steps is rounded twice, its product with the slope, the sum, and the slope twice, each by 2^-24
// of at most 65,535 steps: 0.024. It grows with the distance of the origin.
constexpr double kRounding = 0.04;

// One axis of the grid.
struct Axis {
  Axis(float scene_lo, float scene_hi, float eye, float largest) {
    const float outside = std::max({scene_lo - eye, eye - scene_hi, 0.0F});
    const float extent = std::max({scene_hi - scene_lo, kFlattest * largest, kNearest * outside,
                                   kFinest * std::max(std::abs(scene_lo), std::abs(scene_hi))});
    const double away = extent > 0 ? double{outside} / double{extent} : 0;
    margin = kRounding * (1 + away);
    const double used = kSteps - 4 * (margin + 1);
    scale = extent > 0 ? static_cast<float>(used / double{extent}) : 1.0F;
    lo = scene_lo - static_cast<float>(2 * (margin + 1) / double{scale});
  }

  double steps(float x) const { return (double{x} - double{lo}) * double{scale}; }
  uint lower(float x) const { return corner(std::floor(steps(x) - margin)); }
  uint upper(float x) const { return corner(std::ceil(steps(x) + margin)); }

  static uint corner(double step) {
    check(step >= 0 && step <= kSteps, "a box reaches {} steps of its grid of {}", step, kSteps);
    return static_cast<uint>(step);
  }

  float lo = 0;
  float scale = 1;
  double margin = 0;
};

class Packer {
 public:
  Packer(const Bvh& bvh, const glm::vec3& eye) : bvh_(bvh), axes_(axes_of(bvh.nodes[0], eye)) {
    for (int k = 0; k < 3; ++k) {
      result_.grid.lo[k] = axis(k).lo;
      result_.grid.scale[k] = axis(k).scale;
    }
    // Inner nodes keep their order.
    index_.reserve(bvh.nodes.size());
    uint inner = 0;
    for (const BvhNode& node : bvh.nodes) index_.push_back(node.count == 0 ? inner++ : 0);
  }

  WideNodes pack() {
    if (bvh_.nodes.size() == 1) {
      // The second child is the leaf once more, in a box at the corner of the grid, where there is nothing.
      result_.nodes.push_back({uvec4(corners(bvh_.nodes[0]), 0), uvec4(0, 0, link(0), link(0))});
      return std::move(result_);
    }
    for (std::uint32_t i = 0; i < bvh_.nodes.size(); ++i) {
      if (bvh_.nodes[i].count > 0) continue;
      const std::uint32_t second = bvh_.nodes[i + 1].miss;
      const uvec3 a = corners(bvh_.nodes[i + 1]);
      const uvec3 b = corners(bvh_.nodes[second]);
      result_.nodes.push_back({uvec4(a, b.x), uvec4(b.y, b.z, link(i + 1), link(second))});
    }
    return std::move(result_);
  }

 private:
  static std::array<Axis, 3> axes_of(const BvhNode& root, const glm::vec3& eye) {
    const glm::vec3 size = root.hi - root.lo;
    const float largest = std::max({size.x, size.y, size.z});
    const auto make = [&](int k) { return Axis(root.lo[k], root.hi[k], eye[k], largest); };
    return {make(0), make(1), make(2)};
  }

  const Axis& axis(int k) const { return axes_[static_cast<std::size_t>(k)]; }

  uvec3 corners(const BvhNode& node) const {
    uvec3 result;
    for (int k = 0; k < 3; ++k) result[k] = axis(k).lower(node.lo[k]) | (axis(k).upper(node.hi[k]) << 16);
    return result;
  }

  uint link(std::uint32_t node) const {
    const BvhNode& n = bvh_.nodes[node];
    return n.count == 0 ? index_[node] : LEAF_LINK | (n.first << LEAF_BITS) | n.count;
  }

  const Bvh& bvh_;
  std::array<Axis, 3> axes_;
  std::vector<uint> index_;
  WideNodes result_;
};

}  // namespace

WideNodes pack_wide_nodes(const Bvh& bvh, const glm::vec3& eye) {
  constexpr std::size_t kMostTriangles = std::size_t{1} << (31 - LEAF_BITS);
  check(bvh.order.size() < kMostTriangles, "the scene has {} triangles; its hierarchy can hold up to {}",
        bvh.order.size(), kMostTriangles - 1);
  return Packer(bvh, eye).pack();
}

}  // namespace qtrace::gpu
