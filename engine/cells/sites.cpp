#include "engine/cells/sites.h"

#include "engine/cells/hammersley.h"
#include "engine/cells/site_counts.h"
#include "engine/cells/uv_map.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace {
namespace {

// An object whose islands cover less than about 1/64 of its UV square would need too dense a set.
constexpr std::uint32_t kMostPointsPerSite = 64;

CellSite site_on(const Triangle& t, double u, double v) {
  const auto weigh = [&](const std::array<glm::vec3, 3>& a) {
    return glm::dvec3(a[0]) * (1.0 - u - v) + glm::dvec3(a[1]) * u + glm::dvec3(a[2]) * v;
  };
  glm::dvec3 normal = weigh(t.normal);
  // Opposite vertex normals can cancel; then the face's serves, as in surface.glsl.
  if (glm::length(normal) < 1e-6) {
    normal = area_vector(t.position);
  }
  return {glm::vec3(weigh(t.position)), glm::vec3(glm::normalize(normal))};
}

// Keeps `wanted` of the sites, evenly spread over their order.
std::vector<CellSite> thin(const std::vector<CellSite>& sites, std::size_t wanted) {
  std::vector<CellSite> kept(wanted);
  for (std::size_t i = 0; i < wanted; ++i) kept[i] = sites[i * sites.size() / wanted];
  return kept;
}

std::vector<CellSite> map_points(const Scene& scene, const UvMap& map, std::uint32_t points) {
  std::vector<CellSite> sites;
  std::size_t overlapping = 0;
  for (std::uint32_t i = 0; i < points; ++i) {
    const auto hits = map.find(hammersley(i, points));
    if (hits.empty()) continue;
    const UvHit& hit = hits[hits.size() > 1 ? overlapping++ % hits.size() : 0];
    sites.push_back(site_on(scene.triangles[hit.triangle], hit.u, hit.v));
  }
  return sites;
}

// Empty where the UV map does not yield enough sites.
std::vector<CellSite> place_by_uv(const Scene& scene, const Object& object, std::uint32_t wanted) {
  if (!object.has_uv || wanted == 0) return {};
  const UvMap map(scene, object);
  std::uint32_t points = wanted;
  while (points <= wanted * kMostPointsPerSite) {
    const auto sites = map_points(scene, map, points);
    if (sites.size() >= wanted) return thin(sites, wanted);
    const double alive = std::max<double>(static_cast<double>(sites.size()), points / 8.0);
    points = std::max(points + 1, static_cast<std::uint32_t>(std::ceil(points * (wanted / alive))));
  }
  return {};
}

std::vector<CellSite> place_by_area(const Scene& scene, const Object& object, std::uint32_t wanted) {
  std::vector<double> sums(object.triangle_count);
  double total = 0;
  for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
    sums[i] = total += area_of(scene.triangles[object.first_triangle + i]);
  }
  std::vector<CellSite> sites;
  for (std::uint32_t i = 0; i < wanted; ++i) {
    const glm::dvec2 p = hammersley(i, wanted);
    const auto found = std::upper_bound(sums.begin(), sums.end(), p.x * total) - sums.begin();
    const auto k = std::min(static_cast<std::size_t>(found), sums.size() - 1);
    const double before = k > 0 ? sums[k - 1] : 0;
    // What is left of p.x after choosing the triangle is uniform in it.
    const double x = std::clamp((p.x * total - before) / (sums[k] - before), 0.0, 1.0);
    const double root = std::sqrt(x);
    sites.push_back(site_on(scene.triangles[object.first_triangle + k], root * (1 - p.y), root * p.y));
  }
  return sites;
}

}  // namespace

CellSites place_sites(const Scene& scene, const RlSettings& settings) {
  const std::vector<std::uint32_t> counts = site_counts(scene, settings);
  CellSites cells;
  cells.first.push_back(0);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    std::vector<CellSite> sites;
    if (settings.site_placement == SitePlacement::uv) {
      sites = place_by_uv(scene, object, counts[o]);
      if (sites.empty() && counts[o] > 0) {
        cells.warnings.push_back(
            fmt::format("object '{}' has {}: its Voronoi sites are placed by area", object.name,
                        object.has_uv ? "a UV map that covers nearly nothing" : "no UV map"));
      }
    }
    if (sites.empty()) sites = place_by_area(scene, object, counts[o]);
    cells.sites.insert(cells.sites.end(), sites.begin(), sites.end());
    cells.first.push_back(static_cast<std::uint32_t>(cells.sites.size()));
  }
  return cells;
}

}  // namespace qtrace
