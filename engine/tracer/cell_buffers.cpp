#include "engine/tracer/cell_buffers.h"

#include "engine/cells/site_counts.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
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

static_assert(kMostBoxesAlongAxis < 1U << gpu::LIST_BOX_BITS);

std::vector<gpu::SiteRange> pack_ranges(const CellSites& sites, const SiteLists& lists) {
  std::vector<gpu::SiteRange> ranges;
  for (std::size_t o = 0; o + 1 < sites.first.size(); ++o) {
    gpu::SiteRange next{};
    next.range = glm::uvec4(sites.first[o], sites.first[o + 1] - sites.first[o], 0, 0);
    if (o < lists.objects.size()) {
      const auto& [frame, first_entry] = lists.objects[o];
      const glm::uvec3 boxes = frame.boxes;
      next.range.z = first_entry;
      next.range.w = boxes.x | boxes.y << gpu::LIST_BOX_BITS | boxes.z << (2 * gpu::LIST_BOX_BITS);
      next.frame = glm::vec4(frame.origin, frame.boxes_per_unit);
    }
    ranges.push_back(next);
  }
  return ranges;
}

// Elements that an entry can point to.
constexpr std::size_t kMostListBytes = (std::size_t{1} << (32 - gpu::LIST_COUNT_BITS)) * sizeof(glm::uvec4);

std::size_t bytes_of(const SiteLists& lists) {
  return (lists.starts.size() / 4 + 1 + lists.sites.size()) * sizeof(glm::uvec4);
}

// The entries, four in an element, then the listed sites: see SiteListBuffer in voronoi.glsl.
std::vector<glm::uvec4> pack_lists(const CellSites& sites, const SiteLists& lists) {
  static_assert(kMostListedSites < 1U << gpu::LIST_COUNT_BITS);
  if (lists.starts.empty()) return {};
  const std::size_t entries = lists.starts.size() - 1;
  std::vector<glm::uvec4> packed((entries + 3) / 4, glm::uvec4(0));
  const std::size_t after = packed.size();
  for (std::size_t e = 0; e < entries; ++e) {
    const auto first = static_cast<gpu::uint>(after + lists.starts[e]);
    packed[e / 4][static_cast<int>(e % 4)] =
        first << gpu::LIST_COUNT_BITS | (lists.starts[e + 1] - lists.starts[e]);
  }
  std::size_t object = 0;
  for (std::size_t e = 0; e < entries; ++e) {
    while (object + 1 < lists.objects.size() && e >= lists.objects[object + 1].first_entry) ++object;
    for (std::uint32_t i = lists.starts[e]; i < lists.starts[e + 1]; ++i) {
      const auto& [site, always_fits] = lists.sites[i];
      const glm::vec3 p = sites.sites[sites.first[object] + site].position;
      packed.emplace_back(std::bit_cast<gpu::uint>(p.x), std::bit_cast<gpu::uint>(p.y),
                          std::bit_cast<gpu::uint>(p.z), site | (always_fits ? gpu::LISTED_ALWAYS_FITS : 0U));
    }
  }
  return packed;
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
                                                   : voronoi(scene, settings)) {}

CellBuffers CellBuffers::voronoi(const Scene& scene, const RlSettings& settings) {
  CellSites sites = place_sites(scene, settings);
  const std::vector<SiteNode> nodes = order_as_trees(sites);
  SiteLists lists;
  if (settings.site_search == SiteSearch::lists) {
    lists = build_site_lists(scene, sites, nodes, settings.cell_normal_threshold);
    const std::size_t bytes = bytes_of(lists);
    if (bytes > std::min(gpu::most_buffer_bytes(), kMostListBytes)) {
      sites.warnings.push_back(
          fmt::format("the lists of {} sites would need {} MiB: their tree is searched instead, as by "
                      "rl.site_search tree",
                      sites.sites.size(), bytes >> 20));
      lists = {};
    }
  }
  return {sites, nodes, lists};
}

CellBuffers::CellBuffers(CellSites sites) : CellBuffers(sites, order_as_trees(sites), {}) {}

CellBuffers::CellBuffers(const CellSites& sites, const std::vector<SiteNode>& nodes, const SiteLists& lists)
    : states_(site_states(sites)),
      warnings_(sites.warnings),
      cells_("Voronoi sites", pack_sites(sites, nodes)),
      ranges_("site ranges", pack_ranges(sites, lists)),
      lists_("lists of sites", pack_lists(sites, lists)) {}

CellBuffers::CellBuffers(const CellGrid& grid)
    : states_(grid_states(grid)),
      grid_(grid.frame),
      cells_(kGridRows, grid.rows),
      ranges_("site ranges", 0),
      lists_("lists of sites", 0) {}

void CellBuffers::bind() const {
  cells_.bind_storage(gpu::BINDING_SITES);
  ranges_.bind_storage(gpu::BINDING_SITE_RANGES);
  lists_.bind_storage(gpu::BINDING_SITE_LISTS);
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
