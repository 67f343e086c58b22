#include "engine/cells/uv_map.h"

#include <algorithm>
#include <cmath>

namespace qtrace {
namespace {

constexpr std::size_t kRows = 64;
// A triangle that repeats more often than this along one axis is taken as a mistake of the file and left out:
// each repetition is work and memory.
constexpr double kMostTiles = 64;

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace

UvMap::UvMap(const Scene& scene, const Object& object) : rows_(kRows) {
  for (std::uint32_t i = 0; i < object.triangle_count; ++i) {
    add(object.first_triangle + i, scene.triangles[object.first_triangle + i].uv);
  }
}

std::size_t UvMap::row_of(double v) const {
  return static_cast<std::size_t>(std::clamp(std::floor(v * kRows), 0.0, kRows - 1.0));
}

void UvMap::add(std::uint32_t triangle, const std::array<glm::vec2, 3>& uv) {
  const auto [left, right] = std::minmax({double{uv[0].x}, double{uv[1].x}, double{uv[2].x}});
  const auto [bottom, top] = std::minmax({double{uv[0].y}, double{uv[1].y}, double{uv[2].y}});
  if (right - left > kMostTiles || top - bottom > kMostTiles) return;
  for (double tile_x = std::floor(left); tile_x < right; ++tile_x) {
    for (double tile_y = std::floor(bottom); tile_y < top; ++tile_y) {
      const glm::dvec2 tile(tile_x, tile_y);
      const auto index = static_cast<std::uint32_t>(charts_.size());
      charts_.push_back(
          {triangle, {glm::dvec2(uv[0]) - tile, glm::dvec2(uv[1]) - tile, glm::dvec2(uv[2]) - tile}});
      for (std::size_t row = row_of(bottom - tile_y); row <= row_of(top - tile_y); ++row) {
        rows_[row].push_back(index);
      }
    }
  }
}

std::vector<UvHit> UvMap::find(glm::dvec2 point) const {
  std::vector<UvHit> hits;
  for (const std::uint32_t index : rows_[row_of(point.y)]) {
    const Chart& chart = charts_[index];
    const glm::dvec2 edge1 = chart.corner[1] - chart.corner[0];
    const glm::dvec2 edge2 = chart.corner[2] - chart.corner[0];
    const double area = cross(edge1, edge2);
    if (area == 0.0) continue;
    const glm::dvec2 d = point - chart.corner[0];
    const double u = cross(d, edge2) / area;
    const double v = cross(edge1, d) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) hits.push_back({chart.triangle, u, v});
  }
  return hits;
}

}  // namespace qtrace
