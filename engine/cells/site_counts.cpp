#include "engine/cells/site_counts.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace qtrace {
namespace {

std::vector<double> areas_of(const Scene& scene) {
  std::vector<double> areas;
  for (const Object& object : scene.objects) {
    const auto begin = scene.triangles.begin() + object.first_triangle;
    areas.push_back(std::accumulate(begin, begin + object.triangle_count, 0.0,
                                    [](double sum, const Triangle& t) { return sum + area_of(t); }));
  }
  return areas;
}

// Gives one site to every object whose share is below one, until no such share is left: what these take
// lowers the others' shares. Returns the objects that share the rest.
std::vector<std::size_t> settle_small(const std::vector<double>& areas, std::vector<std::uint32_t>& counts,
                                      std::int64_t& sites) {
  std::vector<std::size_t> open;
  for (std::size_t o = 0; o < areas.size(); ++o) {
    if (areas[o] > 0) open.push_back(o);
  }
  for (std::size_t before = open.size() + 1; open.size() < before;) {
    before = open.size();
    double area = 0;
    for (const std::size_t o : open) area += areas[o];
    const double per_area = static_cast<double>(sites) / area;
    const auto settled = std::erase_if(open, [&](std::size_t o) {
      if (areas[o] * per_area >= 1) return false;
      counts[o] = 1;
      return true;
    });
    sites -= static_cast<std::int64_t>(settled);
  }
  return open;
}

std::vector<std::uint32_t> share(std::int64_t sites, const std::vector<double>& areas) {
  std::vector<std::uint32_t> counts(areas.size(), 0);
  std::vector<std::size_t> open = settle_small(areas, counts, sites);
  double area = 0;
  for (const std::size_t o : open) area += areas[o];
  std::vector<double> remainders(areas.size(), 0.0);
  for (const std::size_t o : open) {
    const double exact = static_cast<double>(sites) * (areas[o] / area);
    counts[o] = static_cast<std::uint32_t>(exact);
    remainders[o] = exact - std::floor(exact);
  }
  for (const std::size_t o : open) sites -= counts[o];
  std::ranges::stable_sort(open, std::ranges::greater(), [&](std::size_t o) { return remainders[o]; });
  for (std::size_t i = 0; i < open.size() && sites > 0; ++i, --sites) ++counts[open[i]];
  return counts;
}

}  // namespace

std::vector<std::uint32_t> site_counts(const Scene& scene, const RlSettings& settings) {
  check(settings.sites_per_object > 0 || settings.total_sites > 0,
        "sites_per_object and total_sites are {} and {}: one of them must be above 0",
        settings.sites_per_object, settings.total_sites);
  if (settings.sites_per_object <= 0) return share(settings.total_sites, areas_of(scene));
  std::vector<std::uint32_t> counts;
  for (const Object& object : scene.objects) {
    counts.push_back(object.triangle_count > 0 ? static_cast<std::uint32_t>(settings.sites_per_object) : 0);
  }
  return counts;
}

}  // namespace qtrace
