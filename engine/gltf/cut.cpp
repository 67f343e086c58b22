#include "engine/gltf/cut.h"

#include "engine/gltf/prism.h"
#include "engine/gltf/rebuild.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <utility>

namespace qtrace::gltf {
namespace {

std::vector<Polygon> without(const std::vector<Polygon>& parts, const Prism& winner, double rounding) {
  std::vector<Polygon> rest;
  for (const Polygon& part : parts) {
    // Cut by the planes of the winner's sides, what lies beside it would fall apart for nothing.
    if (is_wide(winner.inside(part), rounding))
      winner.add_outside(part, rounding, rest);
    else
      rest.push_back(part);
  }
  return rest;
}

void add_part(const Triangle& whole, const Polygon& part, std::vector<Triangle>& triangles) {
  for (std::size_t i = 2; i < part.size(); ++i) {
    Triangle piece = whole;
    const std::array<const Corner*, 3> corners{&part[0], &part[i - 1], &part[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::vec3 b(corners[k]->barycentric);
      piece.position[k] = corners[k]->position;
      piece.normal[k] = glm::normalize(b.x * whole.normal[0] + b.y * whole.normal[1] + b.z * whole.normal[2]);
      piece.uv[k] = b.x * whole.uv[0] + b.y * whole.uv[1] + b.z * whole.uv[2];
    }
    if (area_of(piece) > 0) triangles.push_back(piece);
  }
}

}  // namespace

void cut_out(const Source& source, Scene& scene, std::vector<Cut> cuts, double rounding,
             std::size_t max_triangles) {
  std::ranges::sort(cuts);
  auto next = cuts.cbegin();
  rebuild(scene, [&](std::uint32_t i, std::vector<Triangle>& triangles) {
    const Triangle& whole = scene.triangles[i];
    if (next == cuts.cend() || next->loser != i) {
      triangles.push_back(whole);
      return;
    }
    std::vector<Polygon> parts{polygon_of(whole)};
    for (; next != cuts.cend() && next->loser == i; ++next) {
      parts = without(parts, Prism(scene.triangles[next->winner]), rounding);
      source.check(
          triangles.size() + parts.size() <= max_triangles,
          "without what others cover in its plane, a surface falls apart into more than {} triangles, "
          "which is the most supported",
          max_triangles);
    }
    for (const Polygon& part : parts) add_part(whole, part, triangles);
  });
}

}  // namespace qtrace::gltf
