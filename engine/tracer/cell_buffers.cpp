#include "engine/tracer/cell_buffers.h"

namespace qtrace {
namespace {

constexpr std::uint32_t kSidesPerSite = 2;

std::vector<gpu::Site> pack_sites(const CellSites& sites) {
  std::vector<gpu::Site> packed;
  packed.reserve(sites.sites.size());
  for (const CellSite& s : sites.sites) packed.push_back({glm::vec4(s.position, 0), glm::vec4(s.normal, 0)});
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
    : CellBuffers(place_sites(scene, settings.site_placement, settings.sites_per_object)) {}

CellBuffers::CellBuffers(const CellSites& sites)
    : states_(site_states(sites)),
      warnings_(sites.warnings),
      sites_("Voronoi sites", pack_sites(sites)),
      ranges_("site ranges", pack_ranges(sites)) {}

void CellBuffers::bind() const {
  sites_.bind_storage(gpu::BINDING_SITES);
  ranges_.bind_storage(gpu::BINDING_SITE_RANGES);
}

std::size_t CellBuffers::count(const Scene& scene, const RlSettings& settings) {
  return scene.objects.size() * static_cast<std::size_t>(settings.sites_per_object) * kSidesPerSite;
}

}  // namespace qtrace
