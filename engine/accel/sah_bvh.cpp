#include "engine/accel/sah_bvh.h"
#include "engine/accel/bounds.h"
#include "engine/accel/bvh_input.h"
#include "engine/accel/reinsertion.h"

#include <algorithm>
#include <array>
#include <future>
#include <span>
#include <thread>

namespace qtrace {
namespace {

constexpr int kBins = 32;
// Of one triangle's test, in visits of a node. Measured on llvmpipe (./dev bench): 0.5, 1 and 2 cost a room
// of 200,000 triangles 0, 2 and 5 % of its primary rays, and simple 4, 0 and 1 % of its bounce rays.
constexpr float kTriangleCost = 0.7F;
// Below this depth splits halve the count, so that a leaf is at most 28 levels further down: links hold 2^27
// triangles.
constexpr int kDepthOfHalves = kMaxBvhDepth - 30;
// Smaller subtrees are not worth a thread.
constexpr std::size_t kWorthAThread = 50'000;

struct Item {
  Bounds box;
  std::uint32_t triangle = 0;
};

struct Bin {
  Bounds box;
  std::uint32_t count = 0;
};

struct Split {
  int axis = -1;                                   // -1: there is none that separates centres
  int bin = 0;                                     // first one on the right
  float cost = std::numeric_limits<float>::max();  // of both sides: area x triangles
};

// Places of centres among the bins, along one axis.
struct BinMap {
  BinMap(const Bounds& centres, int axis_of)
      : axis(axis_of),
        lo(centres.lo[axis]),
        per_unit(static_cast<float>(kBins) * 0.9999F / (centres.hi[axis] - centres.lo[axis])) {}

  int bin_of(const Item& item) const {
    return std::clamp(static_cast<int>((item.box.centre()[axis] - lo) * per_unit), 0, kBins - 1);
  }

  int axis;
  float lo;
  float per_unit;
};

Split best_of_axis(const std::array<Bin, kBins>& bins, int axis) {
  std::array<float, kBins> right{};
  Bin sum;
  for (int i = kBins - 1; i > 0; --i) {
    const Bin& bin = bins[static_cast<std::size_t>(i)];
    sum.box.add(bin.box);
    sum.count += bin.count;
    right[static_cast<std::size_t>(i)] =
        sum.count == 0 ? 0 : half_area(sum.box) * static_cast<float>(sum.count);
  }
  Split best;
  sum = {};
  for (int i = 1; i < kBins; ++i) {
    const Bin& bin = bins[static_cast<std::size_t>(i - 1)];
    sum.box.add(bin.box);
    sum.count += bin.count;
    const float left = sum.count == 0 ? 0 : half_area(sum.box) * static_cast<float>(sum.count);
    const float cost = left + right[static_cast<std::size_t>(i)];
    if (cost < best.cost) best = {axis, i, cost};
  }
  return best;
}

Split best_split(std::span<const Item> items, const Bounds& centres) {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    // Written so that coordinates whose difference overflows or vanishes in rounding leave the axis out.
    const BinMap map(centres, axis);
    if (!(map.per_unit > 0) || map.per_unit > std::numeric_limits<float>::max()) continue;
    std::array<Bin, kBins> bins;
    for (const Item& item : items) {
      Bin& bin = bins[static_cast<std::size_t>(map.bin_of(item))];
      bin.box.add(item.box);
      ++bin.count;
    }
    const Split split = best_of_axis(bins, axis);
    if (split.cost < best.cost) best = split;
  }
  return best;
}

class Builder {
 public:
  Builder(const Scene& scene, std::uint32_t leaf_size) : leaf_size_(leaf_size) {
    items_.reserve(scene.triangles.size());
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      items_.push_back({bounds_of(scene.triangles[i]), i});
    }
  }

  Bvh build() {
    const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    Bvh bvh{BvhKind::sah, {}, {}};
    build(items_, 0, 2 * threads, bvh.nodes);
    // So far the miss link holds the size of the subtree, which ends where it leads.
    for (std::uint32_t i = 0; i < bvh.nodes.size(); ++i) {
      const std::uint32_t next = i + bvh.nodes[i].miss;
      bvh.nodes[i].miss = next < bvh.nodes.size() ? next : kNoNode;
    }
    for (const Item& item : items_) bvh.order.push_back(item.triangle);
    return bvh;
  }

 private:
  using Nodes = std::vector<BvhNode>;

  // Appends the subtree of `items`. `tasks`: how many more may be started at once.
  void build(std::span<Item> items, int depth, int tasks, Nodes& nodes) const {
    Bounds box;
    Bounds centres;
    for (const Item& item : items) {
      box.add(item.box);
      centres.add(item.box.centre());
    }
    const std::size_t index = nodes.size();
    const auto first = static_cast<std::uint32_t>(items.data() - items_.data());
    nodes.push_back({box.lo, box.hi, 1, first, static_cast<std::uint32_t>(items.size())});
    const std::size_t left = split(items, box, centres, depth);
    if (left == 0) return;
    nodes[index].count = 0;
    if (tasks > 1 && items.size() > kWorthAThread) {
      Nodes others;
      auto right =
          std::async(std::launch::async, [&] { build(items.subspan(left), depth + 1, tasks / 2, others); });
      build(items.first(left), depth + 1, tasks / 2, nodes);
      right.get();
      nodes.insert(nodes.end(), others.begin(), others.end());
    } else {
      build(items.first(left), depth + 1, 1, nodes);
      build(items.subspan(left), depth + 1, 1, nodes);
    }
    nodes[index].miss = static_cast<std::uint32_t>(nodes.size() - index);
  }

  // Orders the items; how many are on the left, 0 where they are to be a leaf.
  std::size_t split(std::span<Item> items, const Bounds& box, const Bounds& centres, int depth) const {
    if (items.size() == 1) return 0;
    const bool may_be_leaf = items.size() <= leaf_size_;
    const Split best = depth < kDepthOfHalves ? best_split(items, centres) : Split{};
    if (best.axis < 0) return may_be_leaf ? 0 : halve(items, centres);
    const float as_leaf = kTriangleCost * half_area(box) * static_cast<float>(items.size());
    if (may_be_leaf && as_leaf <= half_area(box) + kTriangleCost * best.cost) return 0;
    const BinMap map(centres, best.axis);
    const auto right = std::ranges::partition(items, [&](const Item& i) { return map.bin_of(i) < best.bin; });
    return items.size() - right.size();
  }

  static std::size_t halve(std::span<Item> items, const Bounds& centres) {
    const int axis = centres.longest_axis();
    const std::size_t left = items.size() / 2;
    std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(left),
                             [&](const Item& a, const Item& b) {
                               const float ca = a.box.centre()[axis];
                               const float cb = b.box.centre()[axis];
                               return ca != cb ? ca < cb : a.triangle < b.triangle;
                             });
    return left;
  }

  std::uint32_t leaf_size_;
  std::vector<Item> items_;
};

}  // namespace

Bvh build_sah_bvh(const Scene& scene, std::uint32_t leaf_size) {
  check_leaf_size(leaf_size);
  if (scene.triangles.empty()) return empty_bvh(BvhKind::sah);
  Bvh bvh = Builder(scene, leaf_size).build();
  reinsert_subtrees(bvh);
  return bvh;
}

}  // namespace qtrace
