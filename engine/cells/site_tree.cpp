#include "engine/cells/site_tree.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
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
  explicit TreeBuilder(std::span<const CellSite> sites)
      : sites_(sites), order_(sites.size()), nodes_(sites.size()) {
    std::vector<std::uint32_t> items(sites.size());
    std::iota(items.begin(), items.end(), 0U);
    build(items, 0);
  }

  const std::vector<std::uint32_t>& order() const { return order_; }  // of the sites, node by node
  const std::vector<SiteNode>& nodes() const { return nodes_; }

 private:
  SiteNode make_node(std::span<const std::uint32_t> items) const {
    const CellSite& first = sites_[items[0]];
    SiteNode node{0, first.normal, first.normal};
    glm::vec3 lo = first.position;
    glm::vec3 hi = first.position;
    for (const std::uint32_t i : items) {
      lo = glm::min(lo, sites_[i].position);
      hi = glm::max(hi, sites_[i].position);
      node.lo_normal = glm::min(node.lo_normal, sites_[i].normal);
      node.hi_normal = glm::max(node.hi_normal, sites_[i].normal);
    }
    node.axis = longest(hi - lo);
    return node;
  }

  void build(std::span<std::uint32_t> items, std::size_t node) {
    if (items.empty()) return;
    nodes_[node] = make_node(items);
    const std::size_t left = left_count(items.size());
    // The index decides between equal coordinates: the same sites give the same tree everywhere.
    std::ranges::nth_element(
        items, items.begin() + static_cast<std::ptrdiff_t>(left), {},
        [&](std::uint32_t i) { return std::pair(sites_[i].position[nodes_[node].axis], i); });
    order_[node] = items[left];
    build(items.first(left), 2 * node + 1);
    build(items.subspan(left + 1), 2 * node + 2);
  }

  std::span<const CellSite> sites_;
  std::vector<std::uint32_t> order_;
  std::vector<SiteNode> nodes_;
};

}  // namespace

std::vector<SiteNode> order_as_trees(CellSites& cells) {
  const std::vector<CellSite> sites = std::move(cells.sites);
  cells.sites.clear();
  std::vector<SiteNode> nodes;
  for (std::size_t o = 0; o + 1 < cells.first.size(); ++o) {
    const auto object = std::span(sites).subspan(cells.first[o], cells.first[o + 1] - cells.first[o]);
    const TreeBuilder tree(object);
    for (const std::uint32_t i : tree.order()) cells.sites.push_back(object[i]);
    nodes.insert(nodes.end(), tree.nodes().begin(), tree.nodes().end());
  }
  return nodes;
}

}  // namespace qtrace
