#include "engine/gltf/overlaps.h"

#include "engine/gltf/box_tree.h"

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

// A corner of what is left of a triangle, and where on the triangle it is.
struct Corner {
  glm::dvec3 position;
  glm::dvec3 barycentric;
};
using Polygon = std::vector<Corner>;

Polygon polygon_of(const Triangle& triangle) {
  return {{triangle.position[0], {1, 0, 0}},
          {triangle.position[1], {0, 1, 0}},
          {triangle.position[2], {0, 0, 1}}};
}

// The part of it where `height`, which is linear, is not below 0 (Sutherland and Hodgman 1974).
template <class Height>
Polygon clipped(const Polygon& polygon, Height height) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& a = polygon[i];
    const Corner& b = polygon[(i + 1) % polygon.size()];
    const double at_a = height(a.position), at_b = height(b.position);
    if (at_a >= 0) result.push_back(a);
    if ((at_a < 0) == (at_b < 0)) continue;
    const double t = at_a / (at_a - at_b);
    result.push_back({glm::mix(a.position, b.position, t), glm::mix(a.barycentric, b.barycentric, t)});
  }
  return result;
}

double area(const Polygon& polygon) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum +=
        glm::cross(polygon[i - 1].position - polygon[0].position, polygon[i].position - polygon[0].position);
  }
  return glm::length(sum) / 2;
}

// Whether it is wider than `width`, nearly.
bool is_wide(const Polygon& polygon, double width) {
  double around = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    around += glm::distance(polygon[i].position, polygon[(i + 1) % polygon.size()].position);
  }
  return area(polygon) > width * around / 2;
}

// A prism over a triangle: above it at any height.
class Prism {
 public:
  explicit Prism(const Triangle& triangle) : normal_(glm::normalize(area_vector(triangle.position))) {
    for (std::size_t i = 0; i < 3; ++i) corners_[i] = triangle.position[i];
  }

  // Above its plane.
  double height(const glm::dvec3& p) const { return glm::dot(normal_, p - corners_[0]); }

  Polygon inside(Polygon polygon) const {
    for (std::size_t i = 0; i < 3 && !polygon.empty(); ++i) {
      polygon = clipped(polygon, [&](const glm::dvec3& p) { return within(i, p); });
    }
    return polygon;
  }

  // What of `polygon` is outside, in convex parts that are wider than `width`.
  void add_outside(Polygon polygon, double width, std::vector<Polygon>& parts) const {
    for (std::size_t i = 0; i < 3 && !polygon.empty(); ++i) {
      Polygon part = clipped(polygon, [&](const glm::dvec3& p) { return -within(i, p); });
      if (is_wide(part, width)) parts.push_back(std::move(part));
      polygon = clipped(polygon, [&](const glm::dvec3& p) { return within(i, p); });
    }
  }

 private:
  double within(std::size_t side, const glm::dvec3& p) const {
    const glm::dvec3 edge = glm::normalize(corners_[(side + 1) % 3] - corners_[side]);
    return glm::dot(glm::cross(normal_, edge), p - corners_[side]);
  }

  glm::dvec3 normal_;
  std::array<glm::dvec3, 3> corners_;
};

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

class Overlaps {
 public:
  Overlaps(Source& source, Scene& scene) : source_(source), scene_(scene), rounding_(rounding_of(scene)) {}

  void cut() {
    find();
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

  // One warning for each pair of parts.
  void warn() {
    std::map<std::pair<Part, Part>, double> areas;
    for (const Overlap& overlap : overlaps_)
      areas[{part_of(overlap.loser), part_of(overlap.winner)}] += overlap.area;
    for (const auto& [pair, shared] : areas) {
      const auto& [loser, winner] = pair;
      const bool is_lamp = scene_.materials[winner.second].emission != glm::vec3(0.0F);
      source_.warn(
          "{} ({}) and {} ({}) share an area of {:.4g} in one plane: the second, which {}, is seen there, "
          "and the "
          "first is cut",
          name_of(loser.first), scene_.materials[loser.second].name, name_of(winner.first),
          scene_.materials[winner.second].name, shared, is_lamp ? "emits" : "is smaller");
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
