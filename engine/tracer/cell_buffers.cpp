#include "engine/tracer/cell_buffers.h"

#include "engine/cells/site_counts.h"

#include <glm/common.hpp>

#include <bit>
#include <numeric>
#include <utility>

namespace qtrace {
namespace {

constexpr std::uint32_t kSidesPerSite = 2;
constexpr const char* kGridRows = "grid boxes x 6 normals (rl.grid_resolution)";
static_assert(kNoRow == gpu::NO_ENTRY);

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

std::vector<CellState> grid_states(const CellGrid& grid) {
  std::vector<CellState> states;
  for (const GridCell& cell : grid.cells) states.push_back({cell.centre, cell.normal, kNoObject});
  return states;
}

}  // namespace

CellBuffers::CellBuffers(const Scene& scene, const RlSettings& settings)
    : CellBuffers(settings.cells == CellKind::grid ? CellBuffers(build_grid(scene, settings.grid_resolution))
                                                   : CellBuffers(place_sites(scene, settings))) {}

CellBuffers::CellBuffers(CellSites sites) : CellBuffers(sites, order_as_trees(sites)) {}

CellBuffers::CellBuffers(const CellSites& sites, const std::vector<SiteNode>& nodes)
    : states_(site_states(sites)),
      warnings_(sites.warnings),
      cells_("Voronoi sites", pack_sites(sites, nodes)),
      ranges_("site ranges", pack_ranges(sites)) {}

CellBuffers::CellBuffers(const CellGrid& grid)
    : states_(grid_states(grid)),
      grid_(grid.frame),
      cells_(kGridRows, grid.rows),
      ranges_("site ranges", 0) {}

void CellBuffers::bind() const {
  cells_.bind_storage(gpu::BINDING_SITES);
  ranges_.bind_storage(gpu::BINDING_SITE_RANGES);
}

void CellBuffers::check_size(const Scene& scene, const RlSettings& settings) {
  if (settings.cells == CellKind::grid) {
    const GridFrame frame = grid_frame(scene, settings.grid_resolution);
    gpu::check_buffer_size(kGridRows, frame.entries() * sizeof(std::uint32_t));
  } else {
    gpu::check_buffer_size("Voronoi sites", count(scene, settings) / kSidesPerSite * sizeof(gpu::Site));
  }
}

std::size_t CellBuffers::count(const Scene& scene, const RlSettings& settings) {
  if (settings.cells == CellKind::grid) return build_grid(scene, settings.grid_resolution).cells.size();
  const std::vector<std::uint32_t> counts = site_counts(scene, settings);
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0}) * kSidesPerSite;
}

}  // namespace qtrace
