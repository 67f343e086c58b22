#include "engine/tracer/cell_buffers.h"

#include "engine/cells/site_counts.h"

#include <glm/common.hpp>

#include <bit>
#include <numeric>
#include <utility>

namespace qtrace {
namespace {

constexpr std::uint32_t kSidesPerSite = 2;

// Rounded away from one another.
gpu::uint pack_bounds(glm::vec3 lo, glm::vec3 hi) {
  const auto steps = [](glm::vec3 v) {
    return (v + 1.0F) * (0.5F * static_cast<float>(gpu::NORMAL_BOUND_STEPS));
  };
  const auto whole = [](glm::vec3 v) {
    return glm::uvec3(glm::clamp(v, 0.0F, float{gpu::NORMAL_BOUND_STEPS}));
  };
  const glm::uvec3 low = whole(glm::floor(steps(lo)));
  const glm::uvec3 high = whole(glm::ceil(steps(hi)));
  gpu::uint bits = 0;
  for (const gpu::uint bound : {high.z, high.y, high.x, low.z, low.y, low.x}) {
    bits = (bits << gpu::NORMAL_BOUND_BITS) | bound;
  }
  return bits;
}

std::vector<gpu::Site> pack_sites(const CellSites& sites, const std::vector<SiteNode>& nodes) {
  std::vector<gpu::Site> packed;
  packed.reserve(sites.sites.size());
  for (std::size_t i = 0; i < sites.sites.size(); ++i) {
    const CellSite& s = sites.sites[i];
    const SiteNode& node = nodes[i];
    packed.push_back(
        {glm::vec4(s.position, std::bit_cast<float>(node.axis)),
         glm::vec4(s.normal, std::bit_cast<float>(pack_bounds(node.lo_normal, node.hi_normal)))});
  }
  return packed;
}

std::vector<gpu::SiteRange> pack_ranges(const CellSites& sites) {
  std::vector<gpu::SiteRange> ranges;
  for (std::size_t o = 0; o + 1 < sites.first.size(); ++o) {
    ranges.push_back({sites.first[o], sites.first[o + 1] - sites.first[o]});
  }
  return ranges;
}

std::vector<CellState> site_states(const CellSites& sites) {
  std::vector<CellState> states;
  std::uint32_t object = 0;
  for (std::uint32_t i = 0; i < sites.sites.size(); ++i) {
    while (i >= sites.first[object + 1]) ++object;
    const CellSite& s = sites.sites[i];
    states.push_back({s.position, s.normal, object});
    states.push_back({s.position, -s.normal, object});
  }
  return states;
}

}  // namespace

CellBuffers::CellBuffers(const Scene& scene, const RlSettings& settings)
    : CellBuffers(place_sites(scene, settings)) {}

CellBuffers::CellBuffers(CellSites sites) : CellBuffers(sites, order_as_trees(sites)) {}

CellBuffers::CellBuffers(const CellSites& sites, const std::vector<SiteNode>& nodes)
    : states_(site_states(sites)),
      warnings_(sites.warnings),
      sites_("Voronoi sites", pack_sites(sites, nodes)),
      ranges_("site ranges", pack_ranges(sites)) {}

void CellBuffers::bind() const {
  sites_.bind_storage(gpu::BINDING_SITES);
  ranges_.bind_storage(gpu::BINDING_SITE_RANGES);
}

std::size_t CellBuffers::count(const Scene& scene, const RlSettings& settings) {
  const std::vector<std::uint32_t> counts = site_counts(scene, settings);
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0}) * kSidesPerSite;
}

}  // namespace qtrace
