#include "engine/gltf/overlaps.h"

#include "engine/gltf/box_tree.h"
#include "engine/gltf/parts.h"
#include "engine/gltf/prism.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace qtrace::gltf {
namespace {

// Sixteen times the rounding of the scene's largest coordinate.
constexpr float kRounding = 16 * 0x1p-24F;
// An overlap or a rest that is no wider than so many times that is no surface.
constexpr double kSliver = 4;
// What does not emit overlaps where it shares so much of the smaller part. Bodies that touch, as a pot on a
// book, often share a few triangles' edges in one plane, and no picture shows which of them is met there.
constexpr double kLeastShare = 0.01;

// Both emit: the same, to the same sides.
bool emit_alike(const Scene& scene, const Triangle& a, const Triangle& b) {
  const Material& first = scene.materials[a.material];
  const Material& second = scene.materials[b.material];
  const bool same_sides =
      first.double_sided || glm::dot(area_vector(a.position), area_vector(b.position)) > 0;
  return first.emission == second.emission && first.double_sided == second.double_sided && same_sides;
}

struct Overlap {
  std::uint32_t loser;
  std::uint32_t winner;
  double area;
};

float rounding_of(const Scene& scene) {
  float largest = 0;
  for (const Triangle& triangle : scene.triangles) {
    for (const glm::vec3& p : triangle.position) {
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
  }
  return kRounding * largest;
}

class Overlaps {
 public:
  Overlaps(Source& source, Scene& scene)
      : source_(source), scene_(scene), rounding_(rounding_of(scene)), parts_(scene, rounding_) {}

  void cut() {
    find();
    forget_touches();
    if (overlaps_.empty()) return;
    std::ranges::sort(overlaps_, {},
                      [](const Overlap& overlap) { return std::pair(overlap.loser, overlap.winner); });
    warn();
    rebuild();
  }

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;  // of parts: the loser, the winner

  const Triangle& triangle(std::uint32_t i) const { return scene_.triangles[i]; }
  std::string name_of(const Part& part) const {
    return label("object", part.object, scene_.objects[part.object].name);
  }

  void find() {
    const std::vector<std::uint32_t> candidates = parts_.near_others(scene_, rounding_);
    std::vector<Box> boxes;
    for (const std::uint32_t i : candidates) boxes.push_back(box_of(triangle(i), rounding_));
    const BoxTree tree(boxes);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      tree.visit(boxes[i], [&](std::size_t other) {
        if (i < other) look_at(candidates[i], candidates[other]);
      });
    }
  }

  bool may_matter(std::uint32_t a, std::uint32_t b) const {
    if (parts_.of(a).emits || parts_.of(b).emits) return true;
    return Parts::differ(parts_.of(a), parts_.of(b)) &&
           glm::dot(area_vector(triangle(a).position), area_vector(triangle(b).position)) > 0;
  }

  bool wins(std::uint32_t a, std::uint32_t b) const {
    const Part &part_a = parts_.of(a), &part_b = parts_.of(b);
    if (part_a.emits != part_b.emits) return part_a.emits;
    if (part_a.emits) return a < b;
    return std::pair(part_a.area, parts_.index_of(a)) < std::pair(part_b.area, parts_.index_of(b));
  }

  void look_at(std::uint32_t a, std::uint32_t b) {
    if (!may_matter(a, b)) return;
    const std::uint32_t winner = wins(a, b) ? a : b, loser = winner == a ? b : a;
    const Prism prism(triangle(winner));
    const Polygon shared = prism.inside(polygon_of(triangle(loser)));
    const auto in_plane = [&](const Corner& corner) {
      return std::abs(prism.height(corner.position)) <= static_cast<double>(rounding_);
    };
    if (!std::ranges::all_of(shared, in_plane)) return;
    if (!is_wide(shared, kSliver * static_cast<double>(rounding_))) return;
    source_.check(!parts_.of(loser).emits || emit_alike(scene_, triangle(winner), triangle(loser)),
                  "{} and {} lie in one plane and overlap, and do not emit alike; only one of them would be "
                  "right there",
                  name_of(parts_.of(winner)), name_of(parts_.of(loser)));
    overlaps_.push_back({loser, winner, area(shared)});
  }

  Pair pair_of(const Overlap& overlap) const {
    return {parts_.index_of(overlap.loser), parts_.index_of(overlap.winner)};
  }

  std::map<Pair, double> shared_areas() const {
    std::map<Pair, double> areas;
    for (const Overlap& overlap : overlaps_) areas[pair_of(overlap)] += overlap.area;
    return areas;
  }

  void forget_touches() {
    const std::map<Pair, double> shared = shared_areas();
    std::erase_if(overlaps_, [&](const Overlap& overlap) {
      const Part &loser = parts_.of(overlap.loser), &winner = parts_.of(overlap.winner);
      return !winner.emits && shared.at(pair_of(overlap)) < kLeastShare * std::min(loser.area, winner.area);
    });
  }

  static const char* reason(const Part& loser, const Part& winner) {
    if (winner.emits) return loser.emits ? "emits the same and comes first" : "emits";
    return winner.area < loser.area ? "is smaller" : "comes first in the file";
  }

  // One warning for each pair of parts.
  void warn() {
    for (const auto& [pair, shared] : shared_areas()) {
      const Part &loser = parts_.all()[pair.first], &winner = parts_.all()[pair.second];
      source_.warn(
          "{} ({}) and {} ({}) share an area of {:.4g} in one plane; only the latter is seen there, because "
          "it {}",
          name_of(loser), scene_.materials[loser.material].name, name_of(winner),
          scene_.materials[winner.material].name, shared, reason(loser, winner));
    }
  }

  // Ordered by loser.
  void rebuild() {
    std::vector<Triangle> triangles;
    std::vector<Object> objects;
    auto next = overlaps_.cbegin();
    for (const Object& object : scene_.objects) {
      Object rest = object;
      rest.first_triangle = static_cast<std::uint32_t>(triangles.size());
      for (std::uint32_t i = object.first_triangle; i < object.first_triangle + object.triangle_count; ++i) {
        std::vector<Polygon> parts{polygon_of(scene_.triangles[i])};
        const bool is_whole = next == overlaps_.cend() || next->loser != i;
        for (; next != overlaps_.cend() && next->loser == i; ++next) parts = without(parts, next->winner);
        if (is_whole)
          triangles.push_back(scene_.triangles[i]);
        else
          for (const Polygon& part : parts) add_part(scene_.triangles[i], part, triangles);
      }
      rest.triangle_count = static_cast<std::uint32_t>(triangles.size()) - rest.first_triangle;
      if (rest.triangle_count == 0) continue;
      for (std::size_t i = rest.first_triangle; i < triangles.size(); ++i) {
        triangles[i].object = static_cast<std::uint32_t>(objects.size());
      }
      objects.push_back(std::move(rest));
    }
    scene_.triangles = std::move(triangles);
    scene_.objects = std::move(objects);
  }

  std::vector<Polygon> without(const std::vector<Polygon>& parts, std::uint32_t winner) const {
    const Prism prism(scene_.triangles[winner]);
    std::vector<Polygon> rest;
    for (const Polygon& part : parts) prism.add_outside(part, static_cast<double>(rounding_), rest);
    return rest;
  }

  static void add_part(const Triangle& whole, const Polygon& part, std::vector<Triangle>& triangles) {
    for (std::size_t i = 2; i < part.size(); ++i) {
      Triangle piece = whole;
      const std::array<const Corner*, 3> corners{&part[0], &part[i - 1], &part[i]};
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 b(corners[k]->barycentric);
        piece.position[k] = corners[k]->position;
        piece.normal[k] =
            glm::normalize(b.x * whole.normal[0] + b.y * whole.normal[1] + b.z * whole.normal[2]);
        piece.uv[k] = b.x * whole.uv[0] + b.y * whole.uv[1] + b.z * whole.uv[2];
      }
      if (area_of(piece) > 0) triangles.push_back(piece);
    }
  }

  Source& source_;
  Scene& scene_;
  float rounding_;
  Parts parts_;
  std::vector<Overlap> overlaps_;
};

}  // namespace

void cut_overlaps(Source& source, Scene& scene) { Overlaps(source, scene).cut(); }

}  // namespace qtrace::gltf
