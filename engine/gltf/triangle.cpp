#include "engine/gltf/triangle.h"

#include "engine/gltf/tangents.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <limits>

namespace qtrace::gltf {
namespace {

// The cofactors: the inverse transpose but for its length, and defined for a scale of zero as well.
glm::dmat3 normal_transform(const glm::dmat3& m) {
  const double sign = glm::determinant(m) < 0 ? -1 : 1;
  return sign * glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
}

// Below float's resolution the direction of a normal is rounding noise, and float areas underflow.
bool has_area(const std::array<glm::vec3, 3>& position, double twice_area) {
  constexpr double kMinRelativeHeight = 1e-7;
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 edge = glm::dvec3(position[(i + 1) % 3]) - glm::dvec3(position[i]);
    longest = std::max(longest, glm::dot(edge, edge));
  }
  return twice_area > kMinRelativeHeight * longest && twice_area >= std::numeric_limits<float>::min();
}

}  // namespace

TrianglePlacer::TrianglePlacer(const Source& source, std::string object, const Pose& pose)
    : source_(source),
      object_(std::move(object)),
      pose_(pose),
      normal_to_world_(normal_transform(glm::dmat3(pose.to_world()))),
      is_mirrored_(glm::determinant(glm::dmat3(pose.to_world())) < 0) {}

bool TrianglePlacer::is_mirrored(const Primitive& primitive, std::uint32_t vertex) const {
  return pose_.is_rigid(primitive) ? is_mirrored_
                                   : glm::determinant(glm::dmat3(pose_.to_world(primitive, vertex))) < 0;
}

std::optional<PlacedTriangle> TrianglePlacer::place(const Primitive& primitive, std::size_t index) {
  std::array<std::uint32_t, 3> vertices = primitive.triangle(source_, index);
  if (primitive.joins(vertices)) return std::nullopt;
  ++losses_.triangles;
  if (is_mirrored(primitive, vertices[0])) std::swap(vertices[1], vertices[2]);
  Triangle triangle{};
  for (std::size_t i = 0; i < 3; ++i) triangle.position[i] = world_position(primitive, vertices[i]);
  const glm::dvec3 area = area_vector(triangle.position);
  const double twice_area = glm::length(area);
  if (!has_area(triangle.position, twice_area)) {
    note_flat(primitive, index);
    return std::nullopt;
  }
  const glm::dvec3 face_normal = area / twice_area;
  for (std::size_t i = 0; i < 3; ++i) {
    triangle.normal[i] = world_normal(primitive, vertices[i], face_normal);
    if (primitive.has_uv()) triangle.uv[i] = primitive.uv(source_, vertices[i]);
  }
  return PlacedTriangle{triangle, attributes(primitive, vertices, triangle)};
}

TriangleAttributes TrianglePlacer::attributes(const Primitive& primitive,
                                              const std::array<std::uint32_t, 3>& vertices,
                                              const Triangle& triangle) {
  TriangleAttributes result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (primitive.has_uv1()) result.uv1[i] = primitive.uv1(source_, vertices[i]);
    if (primitive.has_colors()) result.color[i] = color(primitive, vertices[i]);
    if (primitive.has_tangents())
      result.tangent[i] = world_tangent(primitive, vertices[i], triangle.normal[i]);
  }
  return result;
}

void TrianglePlacer::note_flat(const Primitive& primitive, std::size_t index) {
  constexpr std::size_t kNamed = 4;
  if (losses_.flat_triangles < kNamed) {
    losses_.flat_names +=
        fmt::format("{}triangle {} of {}", losses_.flat_triangles == 0 ? "" : ", ", index, primitive.place());
  } else if (losses_.flat_triangles == kNamed) {
    losses_.flat_names += ", and more";
  }
  ++losses_.flat_triangles;
}

glm::vec3 TrianglePlacer::world_position(const Primitive& primitive, std::uint32_t vertex) {
  const glm::dvec3 world(pose_.to_world(primitive, vertex) *
                         glm::dvec4(primitive.position(source_, vertex), 1.0));
  const glm::dvec3 size = glm::abs(world);
  if (std::max({size.x, size.y, size.z}) > std::numeric_limits<float>::max()) {
    source_.fail("{}: vertex {} of {} overflows in world space; smaller positions or scales would be right",
                 object_, vertex, primitive.place());
  }
  const glm::dvec3 unmoved = glm::abs(world - glm::dvec3(pose_.to_world()[3]));
  extent_ = std::max({extent_, unmoved.x, unmoved.y, unmoved.z});
  return world;
}

// Normals on the front side of their face can be interpolated without ever cancelling out.
glm::vec3 TrianglePlacer::world_normal(const Primitive& primitive, std::uint32_t vertex,
                                       const glm::dvec3& face_normal) {
  if (!primitive.has_normals()) return face_normal;
  const glm::dvec3 local(primitive.normal(source_, vertex));
  if (local == glm::dvec3(0.0)) {
    ++losses_.zero_normals;
    return face_normal;
  }
  const glm::dvec3 world = pose_.is_rigid(primitive)
                               ? normal_to_world_ * local
                               : normal_transform(glm::dmat3(pose_.to_world(primitive, vertex))) * local;
  const double length = glm::length(world);
  if (length > 0 && glm::dot(world, face_normal) > 0) return world / length;
  ++losses_.opposed_normals;
  return face_normal;
}

// Along the surface it is carried by the transform itself. Where that mirrors, the sense of the normal, the
// tangent and the third axis turns round.
glm::vec4 TrianglePlacer::world_tangent(const Primitive& primitive, std::uint32_t vertex,
                                        const glm::vec3& normal) const {
  const glm::vec4 local = primitive.tangent(source_, vertex);
  const glm::dvec3 world = glm::dmat3(pose_.to_world(primitive, vertex)) * glm::dvec3(glm::vec3(local));
  const float side = local.w < 0 ? -1.0F : 1.0F;
  return {along_surface(world, normal), is_mirrored(primitive, vertex) ? -side : side};
}

// glTF 2.0, section 3.7.2.1, has colours clamped.
glm::vec4 TrianglePlacer::color(const Primitive& primitive, std::uint32_t vertex) {
  constexpr float kRounding = 1e-3F;
  const glm::vec4 file = primitive.color(source_, vertex);
  const glm::vec4 meant = glm::clamp(file, 0.0F, 1.0F);
  if (glm::any(glm::greaterThan(glm::abs(file - meant), glm::vec4(kRounding)))) ++losses_.odd_colors;
  return meant;
}

}  // namespace qtrace::gltf
