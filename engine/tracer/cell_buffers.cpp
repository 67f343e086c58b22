#include "engine/tracer/cell_buffers.h"

#include "engine/cells/site_counts.h"

#include <bit>
#include <numeric>
#include <utility>

namespace qtrace {
namespace {

constexpr std::uint32_t kSidesPerSite = 2;

std::vector<gpu::Site> pack_sites(const CellSites& sites, const std::vector<SplitDimension>& dimensions) {
  std::vector<gpu::Site> packed;
  packed.reserve(sites.sites.size());
  for (std::size_t i = 0; i < sites.sites.size(); ++i) {
    const CellSite& s = sites.sites[i];
    const SplitDimension k = dimensions[i];
    packed.push_back({glm::vec4(s.position, std::bit_cast<float>(k)), glm::vec4(s.normal, coordinate(s, k))});
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
    : CellBuffers(place_sites(scene, settings), settings.cell_normal_threshold) {}

CellBuffers::CellBuffers(CellSites sites, double normal_threshold)
    : CellBuffers(sites, order_as_trees(sites, normal_threshold)) {}

CellBuffers::CellBuffers(const CellSites& sites, const std::vector<SplitDimension>& dimensions)
    : states_(site_states(sites)),
      warnings_(sites.warnings),
      sites_("Voronoi sites", pack_sites(sites, dimensions)),
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
