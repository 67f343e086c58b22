#include "engine/gltf/overlaps.h"

#include "engine/gltf/coplanar.h"
#include "engine/gltf/parts.h"
#include "engine/gltf/prism.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace qtrace::gltf {
namespace {

// By how much rounding moves a hit, and a position in the file, as parts of the largest coordinate.
constexpr float kOfHits = 16 * 0x1p-24F;
constexpr float kOfPositions = 4 * 0x1p-24F;
// What does not emit overlaps where it shares so much of the smaller part. Bodies that touch, as a pot on a
// book, often share a few triangles' edges in one plane, and no picture shows which of them is met there.
constexpr double kLeastShare = 0.01;
// Two parts are the sides of a card where they share so much of both. Of a box that stands on something it is
// a sixth.
constexpr double kCard = 0.6;

float largest_coordinate(const glm::vec3& p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// The eye counts as well: rays start there.
float rounding_of(const Scene& scene, float extent) {
  float largest = largest_coordinate(glm::vec3(scene.camera.world_from_camera[3]));
  for (const Triangle& triangle : scene.triangles) {
    for (const glm::vec3& p : triangle.position) largest = std::max(largest, largest_coordinate(p));
  }
  return std::max(kOfHits * largest, kOfPositions * extent);
}

bool emit_alike(const Scene& scene, const Part& a, const Part& b) {
  const Material &first = scene.materials[a.material], &second = scene.materials[b.material];
  return first.emission == second.emission && first.double_sided == second.double_sided;
}

// What two parts share, on the same side or on opposite ones.
struct Contact {
  double shared = 0;
  std::set<std::uint32_t> of_a, of_b;  // triangles
};

// What becomes of it.
enum class Verdict { left, a_wins, b_wins, first_wins, moved_apart };

class Overlaps {
 public:
  Overlaps(Source& source, Scene& scene, float extent, std::size_t max_triangles)
      : source_(source),
        scene_(scene),
        max_triangles_(max_triangles),
        rounding_(rounding_of(scene, extent)),
        parts_(scene, rounding_),
        overlaps_(find_overlaps(source, scene, parts_, rounding_)) {}

  void cut() {
    judge();
    if (cuts_.empty() && moved_.empty()) return;
    for (const std::uint32_t i : moved_) move_out(scene_.triangles[i]);
    std::ranges::sort(cuts_);
    rebuild();
  }

 private:
  // Of two parts, the first of them with the lower index, and whether they face opposite sides.
  using Key = std::tuple<std::uint32_t, std::uint32_t, bool>;

  struct Cut {
    std::uint32_t loser;
    std::uint32_t winner;
    auto operator<=>(const Cut&) const = default;
  };

  const Part& part(std::uint32_t index) const { return parts_.all()[index]; }
  std::string name_of(const Part& part) const {
    return label("object", part.object, scene_.objects[part.object].name);
  }
  std::string name_with_material(const Part& part) const {
    return fmt::format("{} ({})", name_of(part), scene_.materials[part.material].name);
  }

  // The triangle of the key's first part comes first.
  std::pair<Key, std::pair<std::uint32_t, std::uint32_t>> sorted(const Overlap& overlap) const {
    const std::uint32_t a = parts_.index_of(overlap.a), b = parts_.index_of(overlap.b);
    if (b < a) return {{b, a, overlap.is_opposite}, {overlap.b, overlap.a}};
    return {{a, b, overlap.is_opposite}, {overlap.a, overlap.b}};
  }

  double area_of_all(const std::set<std::uint32_t>& triangles) const {
    double sum = 0;
    for (const std::uint32_t i : triangles) sum += area_of(scene_.triangles[i]);
    return sum;
  }

  void judge() {
    std::map<Key, Contact> contacts;
    for (const Overlap& overlap : overlaps_) {
      const auto [key, triangles] = sorted(overlap);
      Contact& contact = contacts[key];
      contact.shared += overlap.area;
      contact.of_a.insert(triangles.first);
      contact.of_b.insert(triangles.second);
    }
    std::map<Key, Verdict> verdicts;
    for (const auto& [key, contact] : contacts) verdicts[key] = verdict(key, contact);
    for (const Overlap& overlap : overlaps_) {
      const auto [key, triangles] = sorted(overlap);
      carry_out(verdicts.at(key), triangles.first, triangles.second);
    }
  }

  Verdict verdict(const Key& key, const Contact& contact) {
    const auto& [index_a, index_b, is_opposite] = key;
    const Part &a = part(index_a), &b = part(index_b);
    if (is_opposite && is_card(index_a == index_b ? 2 * contact.shared : contact.shared, a, b)) {
      source_.warn(
          "{} and {} lie back to back in one plane, over an area of {:.4g}; each is seen from the side that "
          "it "
          "faces",
          name_with_material(a), name_with_material(b), contact.shared);
      return Verdict::moved_apart;
    }
    if (a.emits != b.emits)
      return announced(a.emits ? Verdict::a_wins : Verdict::b_wins, key, contact, "emits");
    if (is_opposite) return Verdict::left;
    if (a.emits) {
      source_.check(
          emit_alike(scene_, a, b),
          "{} and {} lie in one plane and overlap, and do not emit alike; only one of them would be "
          "right there",
          name_of(a), name_of(b));
      return announced(Verdict::first_wins, key, contact, "emits the same and comes first");
    }
    if (contact.shared < kLeastShare * std::min(a.area, b.area)) return Verdict::left;
    return of_two_that_do_not_emit(key, contact);
  }

  static bool is_card(double shared, const Part& a, const Part& b) {
    return shared >= kCard * std::max(a.area, b.area);
  }

  Verdict of_two_that_do_not_emit(const Key& key, const Contact& contact) {
    const Part &a = part(std::get<0>(key)), &b = part(std::get<1>(key));
    // Both share the same area: which has less around it? Sums of areas are rounded.
    constexpr double kSame = 1e-6;
    const double around_a = area_of_all(contact.of_a), around_b = area_of_all(contact.of_b);
    if (std::abs(around_a - around_b) > kSame * around_a) {
      return announced(around_a < around_b ? Verdict::a_wins : Verdict::b_wins, key, contact,
                       "lies more wholly on the other");
    }
    if (a.area != b.area) {
      return announced(a.area < b.area ? Verdict::a_wins : Verdict::b_wins, key, contact, "is smaller");
    }
    return announced(Verdict::a_wins, key, contact, "comes first in the file");
  }

  Verdict announced(Verdict verdict, const Key& key, const Contact& contact, const char* reason) {
    const Part &a = part(std::get<0>(key)), &b = part(std::get<1>(key));
    const bool a_wins = verdict != Verdict::b_wins;
    source_.warn(
        "{} and {} share an area of {:.4g} in one plane; only the latter is seen there, because it {}",
        name_with_material(a_wins ? b : a), name_with_material(a_wins ? a : b), contact.shared, reason);
    return verdict;
  }

  void carry_out(Verdict verdict, std::uint32_t a, std::uint32_t b) {
    if (verdict == Verdict::left) return;
    if (verdict == Verdict::moved_apart) {
      moved_.insert({a, b});
      return;
    }
    const bool a_wins = verdict == Verdict::a_wins || (verdict == Verdict::first_wins && a < b);
    cuts_.push_back(a_wins ? Cut{b, a} : Cut{a, b});
  }

  void move_out(Triangle& triangle) const {
    const glm::vec3 step = rounding_ * glm::vec3(glm::normalize(area_vector(triangle.position)));
    for (glm::vec3& p : triangle.position) p += step;
  }

  void rebuild() {
    std::vector<Triangle> triangles;
    std::vector<Object> objects;
    auto next = cuts_.cbegin();
    for (const Object& object : scene_.objects) {
      Object rest = object;
      rest.first_triangle = static_cast<std::uint32_t>(triangles.size());
      for (std::uint32_t i = object.first_triangle; i < object.first_triangle + object.triangle_count; ++i) {
        std::vector<Polygon> parts{polygon_of(scene_.triangles[i])};
        const bool is_whole = next == cuts_.cend() || next->loser != i;
        for (; next != cuts_.cend() && next->loser == i; ++next) parts = without(parts, next->winner);
        if (is_whole)
          triangles.push_back(scene_.triangles[i]);
        else
          for (const Polygon& part : parts) add_part(scene_.triangles[i], part, triangles);
      }
      source_.check(
          triangles.size() <= max_triangles_,
          "without what overlaps in one plane the scene has more than {} triangles, which is the most "
          "supported",
          max_triangles_);
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
    for (const Polygon& part : parts) {
      // Cut by the planes of the winner's sides, what lies beside it would fall apart for nothing.
      if (is_wide(prism.inside(part), static_cast<double>(rounding_)))
        prism.add_outside(part, static_cast<double>(rounding_), rest);
      else
        rest.push_back(part);
    }
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
  std::size_t max_triangles_;
  float rounding_;
  Parts parts_;
  std::vector<Overlap> overlaps_;
  std::vector<Cut> cuts_;          // sorted by loser before the scene is rebuilt
  std::set<std::uint32_t> moved_;  // triangles
};

}  // namespace

void cut_overlaps(Source& source, Scene& scene, float extent, std::size_t max_triangles) {
  Overlaps(source, scene, extent, max_triangles).cut();
}

}  // namespace qtrace::gltf
