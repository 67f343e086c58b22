#include "engine/gltf/coplanar.h"

#include "engine/gltf/prism.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace qtrace::gltf {
namespace {

// An overlap that is no wider than so many times the rounding is no surface.
constexpr double kSliver = 4;
// Planes that stay within the rounding of each other over that width enclose an angle of no more than half
// a radian, whose cosine has this square.
constexpr double kLeastCosineSquared = 0.77;
constexpr std::size_t kMostOverlaps = std::size_t{1} << 25U;  // 800 MB

std::optional<Overlap> overlap_of(const Scene& scene, std::uint32_t a, std::uint32_t b, double rounding) {
  const Triangle &first = scene.triangles[a], &second = scene.triangles[b];
  const glm::dvec3 n = area_vector(first.position), m = area_vector(second.position);
  const double cosine = glm::dot(n, m);
  if (cosine * cosine < kLeastCosineSquared * glm::dot(n, n) * glm::dot(m, m)) return std::nullopt;
  const Prism prism(first);
  const Polygon shared = prism.inside(polygon_of(second));
  const bool is_in_plane = std::ranges::all_of(
      shared, [&](const Corner& corner) { return std::abs(prism.height(corner.position)) <= rounding; });
  if (!is_in_plane || !is_wide(shared, kSliver * rounding)) return std::nullopt;
  return Overlap{a, b, area(shared), cosine < 0};
}

}  // namespace

std::vector<Overlap> find_overlaps(const Source& source, const Scene& scene, const Parts& parts,
                                   float rounding) {
  const std::vector<std::uint32_t> candidates = parts.near_others(scene, rounding);
  std::vector<Box> boxes;
  for (const std::uint32_t i : candidates) boxes.push_back(box_of(scene.triangles[i], rounding));
  const BoxTree tree(boxes);
  std::vector<Overlap> overlaps;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const std::uint32_t a = candidates[i];
    tree.visit(boxes[i], [&](std::size_t other) {
      const std::uint32_t b = candidates[other];
      if (b <= a || !Parts::differ(parts.of(a), parts.of(b))) return;
      if (const auto overlap = overlap_of(scene, a, b, static_cast<double>(rounding))) {
        overlaps.push_back(*overlap);
      }
    });
    source.check(overlaps.size() <= kMostOverlaps,
                 "more than {} pairs of its triangles overlap in one plane; surfaces apart would be right",
                 kMostOverlaps);
  }
  return overlaps;
}

}  // namespace qtrace::gltf
