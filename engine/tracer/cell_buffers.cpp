#include "engine/tracer/cell_buffers.h"

#include "engine/cells/site_counts.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <utility>

namespace qtrace {
namespace {

constexpr std::uint32_t kSidesPerSite = 2;
constexpr const char* kSites = "Voronoi sites";
constexpr const char* kGridRows = "grid boxes x 6 normals (rl.grid_resolution)";
constexpr gpu::BufferUse kSiteUse = gpu::only_fetched(gpu::Texels::float4);
constexpr gpu::BufferUse kGridUse = gpu::only_fetched(gpu::Texels::uint1);
constexpr gpu::BufferUse kListUse = gpu::only_fetched(gpu::Texels::uint4);
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

// Elements of the lists: see site_lists in voronoi.glsl.
constexpr std::size_t kElementsPerRange = sizeof(gpu::SiteRange) / sizeof(glm::uvec4);
constexpr std::size_t kEntriesPerElement = 4;
constexpr std::size_t kMostPerSite = 2;  // a normal and a position

std::vector<gpu::SiteRange> pack_ranges(const CellSites& sites, const SiteLists& lists) {
  std::vector<gpu::SiteRange> ranges;
  const std::size_t objects = sites.first.size() - 1;
  for (std::size_t o = 0; o < objects; ++o) {
    gpu::SiteRange next{};
    next.range = glm::uvec4(sites.first[o], sites.first[o + 1] - sites.first[o], 0, 0);
    if (o < lists.objects.size()) {
      const auto& [frame, first_entry] = lists.objects[o];
      const glm::uvec3 boxes = frame.boxes;
      next.range.z = static_cast<gpu::uint>(kEntriesPerElement * kElementsPerRange * objects) + first_entry;
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
  return (kElementsPerRange * lists.objects.size() + lists.starts.size() / kEntriesPerElement + 1 +
          kMostPerSite * lists.sites.size()) *
         sizeof(glm::uvec4);
}

glm::uvec4 pack_listed(glm::vec3 v, gpu::uint w) {
  return {std::bit_cast<gpu::uint>(v.x), std::bit_cast<gpu::uint>(v.y), std::bit_cast<gpu::uint>(v.z), w};
}

std::vector<glm::uvec4> pack_lists(const CellSites& sites, const SiteLists& lists) {
  static_assert(kMostPerSite * kMostListedSites < 1U << gpu::LIST_COUNT_BITS);
  const std::vector<gpu::SiteRange> ranges = pack_ranges(sites, lists);
  std::vector<glm::uvec4> packed(kElementsPerRange * ranges.size());
  if (!ranges.empty()) std::memcpy(packed.data(), ranges.data(), ranges.size() * sizeof(ranges[0]));
  if (lists.starts.empty()) return packed;
  const std::size_t entries = lists.starts.size() - 1;
  const std::size_t first_entry = packed.size() * kEntriesPerElement;
  packed.resize(packed.size() + (entries + kEntriesPerElement - 1) / kEntriesPerElement);
  std::size_t object = 0;
  for (std::size_t e = 0; e < entries; ++e) {
    while (object + 1 < lists.objects.size() && e >= lists.objects[object + 1].first_entry) ++object;
    const std::size_t begin = packed.size();
    for (std::uint32_t i = lists.starts[e]; i < lists.starts[e + 1]; ++i) {
      const auto& [number, always_fits] = lists.sites[i];
      const CellSite& site = sites.sites[sites.first[object] + number];
      if (!always_fits) packed.push_back(pack_listed(site.normal, gpu::LISTED_NORMAL));
      packed.push_back(pack_listed(site.position, number));
    }
    packed[(first_entry + e) / kEntriesPerElement][static_cast<int>(e % kEntriesPerElement)] =
        static_cast<gpu::uint>(begin << gpu::LIST_COUNT_BITS | (packed.size() - begin));
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
    if (bytes > std::min(gpu::most_buffer_bytes(kListUse), kMostListBytes)) {
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
      lists_are_complete_(!lists.objects.empty() && lists.complete),
      cells_(kSites, pack_sites(sites, nodes), kSiteUse),
      lists_("lists of sites", pack_lists(sites, lists), kListUse) {}

CellBuffers::CellBuffers(const CellGrid& grid)
    : states_(grid_states(grid)),
      grid_(grid.frame),
      cells_(kGridRows, grid.rows, kGridUse),
      lists_("lists of sites", 0, kListUse) {}

void CellBuffers::bind() const {
  cells_.bind_fetched(gpu::UNIT_SITES);  // or UNIT_GRID_STATES
  lists_.bind_fetched(gpu::UNIT_SITE_LISTS);
}

void CellBuffers::check_size(const Scene& scene, const RlSettings& settings) {
  if (settings.cells == CellKind::grid) {
    const GridFrame frame = grid_frame(scene, settings.grid_resolution);
    gpu::check_buffer_size(kGridRows, frame.entries() * sizeof(std::uint32_t), kGridUse);
  } else {
    gpu::check_buffer_size(kSites, count(scene, settings) / kSidesPerSite * sizeof(gpu::Site), kSiteUse);
  }
}

std::size_t CellBuffers::count(const Scene& scene, const RlSettings& settings) {
  if (settings.cells == CellKind::grid) return build_grid(scene, settings.grid_resolution).cells.size();
  const std::vector<std::uint32_t> counts = site_counts(scene, settings);
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0}) * kSidesPerSite;
}

}  // namespace qtrace
