#include "engine/device_scene/light_groups.h"

#include <map>
#include <numeric>
#include <tuple>

namespace qtrace::gpu {
namespace {

// Disjoint sets with path halving (Tarjan & van Leeuwen 1984).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> connected_groups(const Scene& scene,
                                                         const std::vector<std::uint32_t>& triangles) {
  DisjointSets sets(triangles.size());
  std::map<std::tuple<std::uint32_t, float, float, float>, std::size_t> seen;  // object and vertex
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = scene.triangles[triangles[i]];
    for (const glm::vec3& p : t.position) {
      const auto [found, is_new] = seen.try_emplace({t.object, p.x, p.y, p.z}, i);
      if (!is_new) sets.join(i, found->second);
    }
  }
  std::map<std::size_t, std::size_t> group_of;
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto [found, is_new] = group_of.try_emplace(sets.find(i), groups.size());
    if (is_new) groups.emplace_back();
    groups[found->second].push_back(triangles[i]);
  }
  return groups;
}

}  // namespace qtrace::gpu
