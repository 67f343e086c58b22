#include "engine/gltf/duplicates.h"

#include "engine/gltf/parts.h"
#include "engine/gltf/rebuild.h"

#include <glm/geometric.hpp>

#include <xxhash.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace qtrace::gltf {
namespace {

using Corners = std::array<glm::vec3, 3>;

// In an order of their own, and zeros without a sign.
Corners sorted_corners(const Triangle& triangle) {
  Corners corners = triangle.position;
  for (glm::vec3& p : corners) p += 0.0F;
  std::ranges::sort(corners, {}, [](const glm::vec3& p) { return std::tuple(p.x, p.y, p.z); });
  return corners;
}

struct Duplicate {
  std::uint32_t triangle;
  std::uint32_t original;  // before it, and kept
};

// Both emit; ordered by triangle.
std::vector<Duplicate> find_duplicates(const Scene& scene) {
  const std::vector<Triangle>& triangles = scene.triangles;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    if (!emits(scene.materials[triangles[i].material])) continue;
    const Corners corners = sorted_corners(triangles[i]);
    keys.emplace_back(XXH3_64bits(corners.data(), sizeof(corners)), i);
  }
  std::ranges::sort(keys);
  std::vector<Duplicate> duplicates;
  std::vector<std::uint32_t> kept;  // different triangles of one hash
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i].first != keys[i - 1].first) kept.clear();
    const std::uint32_t triangle = keys[i].second;
    const auto original = std::ranges::find_if(kept, [&](std::uint32_t other) {
      return sorted_corners(triangles[other]) == sorted_corners(triangles[triangle]) &&
             glm::dot(area_vector(triangles[other].position), area_vector(triangles[triangle].position)) > 0;
    });
    if (original == kept.end()) {
      kept.push_back(triangle);
    } else {
      duplicates.push_back({triangle, *original});
    }
  }
  std::ranges::sort(duplicates, {}, &Duplicate::triangle);
  return duplicates;
}

std::string triangle_label(const Scene& scene, std::uint32_t index) {
  const std::size_t object = scene.triangles[index].object;
  return fmt::format("triangle {} of {}", index - scene.objects[object].first_triangle,
                     label("object", object, scene.objects[object].name));
}

std::string middle_of(const Scene& scene, std::uint32_t index) {
  const auto& p = scene.triangles[index].position;
  const glm::dvec3 middle = (glm::dvec3(p[0]) + glm::dvec3(p[1]) + glm::dvec3(p[2])) / 3.0 + scene.origin;
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", middle.x, middle.y, middle.z);
}

// The same of texture coordinates and colours, in the order in which the corners are sorted.
bool have_equal_corners(const Scene& scene, const Triangle& a, const Triangle& b) {
  const auto attributes = [&scene](const Triangle& triangle) {
    return triangle.attributes == kNoAttributes ? TriangleAttributes()
                                                : scene.attributes[triangle.attributes];
  };
  const TriangleAttributes of_a = attributes(a), of_b = attributes(b);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k =
        static_cast<std::size_t>(std::ranges::find(b.position, a.position[i]) - b.position.begin());
    if (a.uv[i] != b.uv[k] || of_a.uv1[i] != of_b.uv1[k] || of_a.color[i] != of_b.color[k]) return false;
  }
  return true;
}

bool shine_alike(const Scene& scene, const Triangle& a, const Triangle& b) {
  Material of_a = scene.materials[a.material], of_b = scene.materials[b.material];
  if (emit_alike(of_a, of_b)) return true;
  of_a.name = of_b.name;
  return of_a == of_b && have_equal_corners(scene, a, b);
}

void check_emission(const Source& source, const Scene& scene, const std::vector<Duplicate>& duplicates) {
  for (const Duplicate& d : duplicates) {
    source.check(
        shine_alike(scene, scene.triangles[d.original], scene.triangles[d.triangle]),
        "{} and {}, about {}, have the same corners but do not emit alike; only one of them would be right",
        triangle_label(scene, d.original), triangle_label(scene, d.triangle), middle_of(scene, d.original));
  }
}

// One warning for each object that loses triangles, which names the first.
void warn_of(Source& source, const Scene& scene, const std::vector<Duplicate>& duplicates) {
  for (auto first = duplicates.begin(); first != duplicates.end();) {
    const std::uint32_t object = scene.triangles[first->triangle].object;
    const auto end = std::find_if(first, duplicates.end(), [&](const Duplicate& d) {
      return scene.triangles[d.triangle].object != object;
    });
    source.warn(
        "{}: dropped {} of {} triangles that lie exactly on others, the first of them {}, about {}, on {}",
        label("object", object, scene.objects[object].name), end - first,
        scene.objects[object].triangle_count, triangle_label(scene, first->triangle),
        middle_of(scene, first->triangle), triangle_label(scene, first->original));
    first = end;
  }
}

}  // namespace

void drop_duplicates(Source& source, Scene& scene) {
  const std::vector<Duplicate> duplicates = find_duplicates(scene);
  if (duplicates.empty()) return;
  check_emission(source, scene, duplicates);
  warn_of(source, scene, duplicates);
  auto next = duplicates.cbegin();
  rebuild(scene, [&](std::uint32_t i, std::vector<Triangle>& triangles) {
    if (next != duplicates.cend() && next->triangle == i) {
      ++next;
    } else {
      triangles.push_back(scene.triangles[i]);
    }
  });
}

}  // namespace qtrace::gltf
