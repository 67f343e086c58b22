#include "engine/cells/site_tree.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

namespace qtrace {
namespace {

// Sites of the left subtree of a left-balanced tree of `count`.
std::size_t left_count(std::size_t count) {
  const std::size_t last_level = std::bit_floor(count);  // most that it holds
  const std::size_t on_last_level = count - (last_level - 1);
  return (last_level - 1) / 2 + std::min(on_last_level, last_level / 2);
}

int longest(glm::vec3 v) { return v.x >= v.y && v.x >= v.z ? 0 : v.y >= v.z ? 1 : 2; }

class TreeBuilder {
 public:
  TreeBuilder(std::span<const CellSite> sites, double reach)
      : sites_(sites), reach_(reach), order_(sites.size()), dimension_(sites.size()) {
    std::vector<std::uint32_t> items(sites.size());
    std::iota(items.begin(), items.end(), 0U);
    build(items, 0);
  }

  const std::vector<std::uint32_t>& order() const { return order_; }  // of the sites, node by node
  const std::vector<SplitDimension>& dimension() const { return dimension_; }  // node by node

 private:
  SplitDimension choose_dimension(std::span<const std::uint32_t> items) const {
    glm::vec3 lo[2], hi[2];
    lo[0] = hi[0] = sites_[items[0]].position;
    lo[1] = hi[1] = sites_[items[0]].normal;
    for (const std::uint32_t i : items) {
      lo[0] = glm::min(lo[0], sites_[i].position);
      hi[0] = glm::max(hi[0], sites_[i].position);
      lo[1] = glm::min(lo[1], sites_[i].normal);
      hi[1] = glm::max(hi[1], sites_[i].normal);
    }
    const glm::vec3 spread = hi[1] - lo[1];
    const int normal = longest(spread);
    const bool splits_normals = static_cast<double>(spread[normal]) > reach_;
    return static_cast<SplitDimension>(splits_normals ? 3 + normal : longest(hi[0] - lo[0]));
  }

  void build(std::span<std::uint32_t> items, std::size_t node) {
    if (items.empty()) return;
    const SplitDimension k = choose_dimension(items);
    const std::size_t left = left_count(items.size());
    // The index decides between equal coordinates: the same sites give the same tree everywhere.
    std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(left), {},
                             [&](std::uint32_t i) { return std::pair(coordinate(sites_[i], k), i); });
    order_[node] = items[left];
    dimension_[node] = k;
    build(items.first(left), 2 * node + 1);
    build(items.subspan(left + 1), 2 * node + 2);
  }

  std::span<const CellSite> sites_;
  double reach_;
  std::vector<std::uint32_t> order_;
  std::vector<SplitDimension> dimension_;
};

}  // namespace

std::vector<SplitDimension> order_as_trees(CellSites& cells, double normal_threshold) {
  const double reach = std::sqrt(std::max(0.0, 2 - 2 * normal_threshold));
  const std::vector<CellSite> sites = std::move(cells.sites);
  cells.sites.clear();
  std::vector<SplitDimension> dimensions;
  for (std::size_t o = 0; o + 1 < cells.first.size(); ++o) {
    const auto object = std::span(sites).subspan(cells.first[o], cells.first[o + 1] - cells.first[o]);
    const TreeBuilder tree(object, reach);
    for (const std::uint32_t i : tree.order()) cells.sites.push_back(object[i]);
    dimensions.insert(dimensions.end(), tree.dimension().begin(), tree.dimension().end());
  }
  return dimensions;
}

}  // namespace qtrace
