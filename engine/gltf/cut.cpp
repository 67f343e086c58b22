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

// Of a value that is linear over a triangle, that at a corner of a part of it.
template <class T>
T at(const Corner& corner, const std::array<T, 3>& values) {
  const glm::vec3 b(corner.barycentric);
  return b.x * values[0] + b.y * values[1] + b.z * values[2];
}

TriangleAttributes attributes_of(const TriangleAttributes& whole,
                                 const std::array<const Corner*, 3>& corners) {
  TriangleAttributes piece;
  for (std::size_t k = 0; k < 3; ++k) {
    piece.uv1[k] = at(*corners[k], whole.uv1);
    piece.color[k] = at(*corners[k], whole.color);
    const glm::vec4 tangent = at(*corners[k], whole.tangent);
    const float length = glm::length(glm::vec3(tangent));
    const glm::vec3 direction = length > 0 ? glm::vec3(tangent) / length : glm::vec3(whole.tangent[0]);
    piece.tangent[k] = {direction, tangent.w < 0 ? -1.0F : 1.0F};
  }
  return piece;
}

void add_part(const Triangle& whole, const Polygon& part, std::vector<Triangle>& triangles,
              std::vector<TriangleAttributes>& attributes) {
  for (std::size_t i = 2; i < part.size(); ++i) {
    Triangle piece = whole;
    const std::array<const Corner*, 3> corners{&part[0], &part[i - 1], &part[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      piece.position[k] = corners[k]->position;
      piece.normal[k] = glm::normalize(at(*corners[k], whole.normal));
      piece.uv[k] = at(*corners[k], whole.uv);
    }
    if (area_of(piece) <= 0) continue;
    if (whole.attributes != kNoAttributes) {
      piece.attributes = static_cast<std::uint32_t>(attributes.size());
      attributes.push_back(attributes_of(attributes[whole.attributes], corners));
    }
    triangles.push_back(piece);
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
    for (const Polygon& part : parts) add_part(whole, part, triangles, scene.attributes);
  });
}

}  // namespace qtrace::gltf
