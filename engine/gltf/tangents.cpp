#include "engine/gltf/tangents.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

namespace qtrace::gltf {
namespace {

// Position, normal, texture coordinates and side of a corner; zeros without a sign.
using Key = std::array<float, 9>;

struct KeyHash {
  std::size_t operator()(const Key& key) const { return XXH3_64bits(key.data(), sizeof(key)); }
};

// How a triangle's texture lies on it.
struct Direction {
  glm::dvec3 tangent;  // along growing u
  float side;          // as the w of TriangleAttributes::tangent
};

std::optional<Direction> direction_of(const Triangle& triangle, const std::array<glm::vec2, 3>& uv) {
  const glm::dvec3 p(triangle.position[0]);
  const glm::dvec3 a = glm::dvec3(triangle.position[1]) - p, b = glm::dvec3(triangle.position[2]) - p;
  const glm::dvec2 s = glm::dvec2(uv[1]) - glm::dvec2(uv[0]), t = glm::dvec2(uv[2]) - glm::dvec2(uv[0]);
  // Of a triangle that is seen counter-clockwise the coordinates go clockwise, as v points down, unless they
  // are mirrored.
  const double area = s.x * t.y - t.x * s.y;
  const glm::dvec3 along_u = (area < 0 ? -1.0 : 1.0) * (t.y * a - s.y * b);
  if (area == 0 || along_u == glm::dvec3(0.0)) return std::nullopt;
  return Direction{glm::normalize(along_u), area < 0 ? 1.0F : -1.0F};
}

Key key_of(const Triangle& triangle, const std::array<glm::vec2, 3>& uv, std::size_t i, float side) {
  const glm::vec3 &p = triangle.position[i], &n = triangle.normal[i];
  Key key{p.x, p.y, p.z, n.x, n.y, n.z, uv[i].x, uv[i].y, side};
  for (float& value : key) value += 0.0F;
  return key;
}

// Between the sides that meet in a corner, as they are seen along its normal.
double angle_at(const Triangle& triangle, std::size_t i) {
  const glm::dvec3 p(triangle.position[i]), normal(triangle.normal[i]);
  const glm::dvec3 a = along_surface(glm::dvec3(triangle.position[(i + 1) % 3]) - p, normal);
  const glm::dvec3 b = along_surface(glm::dvec3(triangle.position[(i + 2) % 3]) - p, normal);
  return std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0));
}

class Generator {
 public:
  Generator(std::span<const Triangle> triangles, std::size_t uv_set,
            std::vector<TriangleAttributes>& attributes)
      : triangles_(triangles), uv_set_(uv_set), attributes_(attributes) {}

  void add_all() {
    for (const Triangle& triangle : triangles_) {
      const auto direction = direction_of(triangle, uv(triangle));
      if (!direction) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        sums_[key_of(triangle, uv(triangle), i, direction->side)] +=
            angle_at(triangle, i) * along_surface(direction->tangent, glm::dvec3(triangle.normal[i]));
      }
    }
  }

  void set_all() {
    for (const Triangle& triangle : triangles_) {
      const auto direction = direction_of(triangle, uv(triangle));
      for (std::size_t i = 0; i < 3; ++i) {
        attributes_[triangle.attributes].tangent[i] =
            direction ? tangent(triangle, i, direction->side, direction->tangent) : borrowed(triangle, i);
      }
    }
  }

 private:
  const std::array<glm::vec2, 3>& uv(const Triangle& triangle) const {
    return uv_set_ == 0 ? triangle.uv : attributes_[triangle.attributes].uv1;
  }

  // Where the tangents that meet cancel out, the triangle's own.
  glm::vec4 tangent(const Triangle& triangle, std::size_t i, float side, const glm::dvec3& own) const {
    constexpr double kCancelled = 1e-9;
    const auto sum = sums_.find(key_of(triangle, uv(triangle), i, side));
    const bool is_there = sum != sums_.end() && glm::length(sum->second) > kCancelled;
    return {along_surface(is_there ? sum->second : own, triangle.normal[i]), side};
  }

  glm::vec4 borrowed(const Triangle& triangle, std::size_t i) const {
    for (const float side : {1.0F, -1.0F}) {
      if (sums_.contains(key_of(triangle, uv(triangle), i, side)))
        return tangent(triangle, i, side, glm::dvec3(0.0));
    }
    return {along_surface(glm::dvec3(0.0), triangle.normal[i]), 1.0F};
  }

  std::span<const Triangle> triangles_;
  std::size_t uv_set_;
  std::vector<TriangleAttributes>& attributes_;
  std::unordered_map<Key, glm::dvec3, KeyHash> sums_;
};

}  // namespace

glm::dvec3 along_surface(const glm::dvec3& direction, const glm::dvec3& normal) {
  constexpr double kRounding = 1e-6;  // of what is parallel to the normal
  const glm::dvec3 along = direction - glm::dot(direction, normal) * normal;
  if (glm::length(along) > kRounding * glm::length(direction)) return glm::normalize(along);
  const glm::dvec3 size = glm::abs(normal);
  glm::dvec3 axis(0.0);
  axis[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1;
  return glm::normalize(axis - glm::dot(axis, normal) * normal);
}

void generate_tangents(std::span<const Triangle> triangles, std::size_t uv_set,
                       std::vector<TriangleAttributes>& attributes) {
  Generator generator(triangles, uv_set, attributes);
  generator.add_all();
  generator.set_all();
}

}  // namespace qtrace::gltf
