#include "engine/gltf/overlaps.h"

#include "engine/gltf/box_tree.h"
#include "engine/gltf/prism.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace qtrace::gltf {
namespace {

// Sixteen times the rounding of the scene's largest coordinate.
constexpr double kRounding = 16 * 0x1p-24;
// An overlap or a rest that is no wider than so many times that is no surface.
constexpr double kSliver = 4;
// What does not emit overlaps where it shares so much of the smaller part. Bodies that touch, as a pot on a
// book, often share a few triangles' edges in one plane, and no picture shows which of them is met there.
constexpr double kLeastShare = 0.01;

bool emits(const Scene& scene, std::uint32_t triangle) {
  return scene.materials[scene.triangles[triangle].material].emission != glm::vec3(0.0F);
}

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

double rounding_of(const Scene& scene) {
  double largest = 0;
  for (const Triangle& triangle : scene.triangles) {
    for (const glm::vec3& p : triangle.position) {
      largest = std::max({largest, std::abs(double{p.x}), std::abs(double{p.y}), std::abs(double{p.z})});
    }
  }
  return kRounding * largest;
}

// What an object has of one material, which wins or loses as a whole.
using Part = std::pair<std::uint32_t, std::uint32_t>;  // object, material
using Pair = std::pair<Part, Part>;                    // the loser, the winner

class Overlaps {
 public:
  Overlaps(Source& source, Scene& scene) : source_(source), scene_(scene), rounding_(rounding_of(scene)) {}

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
  const Triangle& triangle(std::uint32_t i) const { return scene_.triangles[i]; }
  Part part_of(std::uint32_t i) const { return {triangle(i).object, triangle(i).material}; }
  std::string name_of(std::uint32_t object) const {
    return label("object", object, scene_.objects[object].name);
  }

  // Where all that does not emit has one material, emitters are all that can overlap with something else.
  std::vector<std::uint32_t> candidates() const {
    std::vector<std::uint32_t> emitters;
    std::set<std::uint32_t> others;
    for (std::uint32_t i = 0; i < scene_.triangles.size(); ++i) {
      if (emits(scene_, i)) {
        emitters.push_back(i);
      } else if (others.size() < 2) {
        others.insert(triangle(i).material);
      }
    }
    if (others.size() < 2) return emitters;
    std::vector<std::uint32_t> all(scene_.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    return all;
  }

  void find() {
    const std::vector<std::uint32_t> found_in = candidates();
    if (found_in.empty()) return;
    const bool has_all = found_in.size() == scene_.triangles.size();
    for (std::uint32_t i = 0; i < scene_.triangles.size(); ++i) areas_[part_of(i)] += area_of(triangle(i));
    std::vector<Box> boxes;
    for (const std::uint32_t i : found_in) boxes.push_back(box_of(triangle(i), rounding_));
    const BoxTree tree(std::move(boxes));
    for (std::uint32_t i = 0; i < scene_.triangles.size(); ++i) {
      tree.visit(box_of(triangle(i), rounding_), [&](std::size_t found) {
        const std::uint32_t other = found_in[found];
        const bool comes_twice = has_all || emits(scene_, i);
        if (i != other && (!comes_twice || i < other)) look_at(i, other);
      });
    }
  }

  bool may_matter(std::uint32_t a, std::uint32_t b) const {
    if (emits(scene_, a) || emits(scene_, b)) return true;
    return triangle(a).material != triangle(b).material &&
           glm::dot(area_vector(triangle(a).position), area_vector(triangle(b).position)) > 0;
  }

  bool wins(std::uint32_t a, std::uint32_t b) const {
    if (emits(scene_, a) != emits(scene_, b)) return emits(scene_, a);
    if (emits(scene_, a)) return a < b;
    return std::pair(areas_.at(part_of(a)), part_of(a)) < std::pair(areas_.at(part_of(b)), part_of(b));
  }

  void look_at(std::uint32_t a, std::uint32_t b) {
    if (!may_matter(a, b)) return;
    const std::uint32_t winner = wins(a, b) ? a : b, loser = winner == a ? b : a;
    const Prism prism(triangle(winner));
    const Polygon shared = prism.inside(polygon_of(triangle(loser)));
    const bool in_plane = std::ranges::all_of(
        shared, [&](const Corner& corner) { return std::abs(prism.height(corner.position)) <= rounding_; });
    if (!in_plane || !is_wide(shared, kSliver * rounding_)) return;
    source_.check(!emits(scene_, loser) || emit_alike(scene_, triangle(winner), triangle(loser)),
                  "{} and {} lie in one plane and overlap, and do not emit alike; only one of them would be "
                  "right there",
                  name_of(triangle(winner).object), name_of(triangle(loser).object));
    overlaps_.push_back({loser, winner, area(shared)});
  }

  Pair pair_of(const Overlap& overlap) const { return {part_of(overlap.loser), part_of(overlap.winner)}; }

  std::map<Pair, double> shared_areas() const {
    std::map<Pair, double> areas;
    for (const Overlap& overlap : overlaps_) areas[pair_of(overlap)] += overlap.area;
    return areas;
  }

  bool is_lamp(const Part& part) const { return scene_.materials[part.second].emission != glm::vec3(0.0F); }

  void forget_touches() {
    const std::map<Pair, double> shared = shared_areas();
    std::erase_if(overlaps_, [&](const Overlap& overlap) {
      const Pair pair = pair_of(overlap);
      return !is_lamp(pair.second) &&
             shared.at(pair) < kLeastShare * std::min(areas_.at(pair.first), areas_.at(pair.second));
    });
  }

  const char* reason(const Part& loser, const Part& winner) const {
    if (is_lamp(winner)) return is_lamp(loser) ? "emits the same and comes first" : "emits";
    return areas_.at(winner) < areas_.at(loser) ? "is smaller" : "comes first in the file";
  }

  // One warning for each pair of parts.
  void warn() {
    for (const auto& [pair, shared] : shared_areas()) {
      const auto& [loser, winner] = pair;
      source_.warn(
          "{} ({}) and {} ({}) share an area of {:.4g} in one plane; only the latter is seen there, because "
          "it {}",
          name_of(loser.first), scene_.materials[loser.second].name, name_of(winner.first),
          scene_.materials[winner.second].name, shared, reason(loser, winner));
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
    for (const Polygon& part : parts) prism.add_outside(part, rounding_, rest);
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
  double rounding_;
  std::map<Part, double> areas_;
  std::vector<Overlap> overlaps_;
};

}  // namespace

void cut_overlaps(Source& source, Scene& scene) { Overlaps(source, scene).cut(); }

}  // namespace qtrace::gltf
