#include "engine/gltf/overlaps.h"

#include "engine/gltf/coplanar.h"
#include "engine/gltf/cut.h"
#include "engine/gltf/parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
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

// What two parts share, on the same side or on opposite ones.
struct Contact {
  double shared = 0;
  std::set<std::uint32_t> of_a, of_b;  // triangles
};

// What becomes of it.
enum class Verdict { left, a_wins, b_wins, first_wins, a_lifted, b_lifted, moved_apart };

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
    cut_out(source_, scene_, std::move(cuts_), static_cast<double>(rounding_), max_triangles_);
  }

 private:
  // Of two parts, the first of them with the lower index, and whether they face opposite sides.
  using Key = std::tuple<std::uint32_t, std::uint32_t, bool>;

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
          emit_alike(scene_.materials[a.material], scene_.materials[b.material]),
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
    if ((a_wins ? a : b).is_see_through) {
      source_.warn(
          "{} and {} share an area of {:.4g} in one plane; the latter lets light pass, and is lifted off the "
          "other",
          name_with_material(a_wins ? b : a), name_with_material(a_wins ? a : b), contact.shared);
      return a_wins ? Verdict::a_lifted : Verdict::b_lifted;
    }
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
    if (verdict == Verdict::a_lifted || verdict == Verdict::b_lifted) {
      moved_.insert(verdict == Verdict::a_lifted ? a : b);
      return;
    }
    const bool a_wins = verdict == Verdict::a_wins || (verdict == Verdict::first_wins && a < b);
    cuts_.push_back(a_wins ? Cut{b, a} : Cut{a, b});
  }

  void move_out(Triangle& triangle) const {
    const glm::vec3 step = rounding_ * glm::vec3(glm::normalize(area_vector(triangle.position)));
    for (glm::vec3& p : triangle.position) p += step;
  }

  Source& source_;
  Scene& scene_;
  std::size_t max_triangles_;
  float rounding_;
  Parts parts_;
  std::vector<Overlap> overlaps_;
  std::vector<Cut> cuts_;
  std::set<std::uint32_t> moved_;  // triangles
};

}  // namespace

void cut_overlaps(Source& source, Scene& scene, float extent, std::size_t max_triangles) {
  Overlaps(source, scene, extent, max_triangles).cut();
}

}  // namespace qtrace::gltf
