#include "engine/gltf/origin.h"

#include "engine/gltf/pose.h"

#include <glm/common.hpp>

#include <algorithm>
#include <limits>

namespace qtrace::gltf {
namespace {

// In half sizes of the scene: six of a float's 24 bits.
constexpr double kFar = 64;

struct Bounds {
  glm::dvec3 lo{std::numeric_limits<double>::infinity()};
  glm::dvec3 hi{-std::numeric_limits<double>::infinity()};
};

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

void add_primitive(const Source& source, const Primitive& primitive, const Pose& pose, Bounds& bounds) {
  for (std::size_t i = 0; i < primitive.triangle_count(); ++i) {
    for (const std::uint32_t vertex : primitive.triangle(source, i)) {
      const glm::dvec3 p(pose.to_world(primitive, vertex) *
                         glm::dvec4(primitive.position(source, vertex), 1.0));
      bounds.lo = glm::min(bounds.lo, p);
      bounds.hi = glm::max(bounds.hi, p);
    }
  }
}

Bounds bounds_of(const Source& source, const std::vector<PlacedNode>& nodes) {
  Bounds bounds;
  const NodeTransforms transforms(source, nodes);
  for (const PlacedNode& node : nodes) {
    if (node.mesh < 0) continue;
    const Pose pose(source, node, transforms);
    for (std::size_t i = 0; i < source.model.meshes[pose.mesh()].primitives.size(); ++i) {
      add_primitive(source, pose.primitive(i), pose, bounds);
    }
  }
  return bounds;
}

}  // namespace

glm::dvec3 centre_nodes(const Source& source, std::vector<PlacedNode>& nodes) {
  const Bounds bounds = bounds_of(source, nodes);
  if (bounds.lo.x > bounds.hi.x) return glm::dvec3(0.0);  // no triangles, which is refused elsewhere
  const glm::dvec3 centre = (bounds.lo + bounds.hi) * 0.5;
  const double half_size = largest(bounds.hi - bounds.lo) * 0.5;
  if (largest(glm::abs(centre)) <= kFar * half_size) return glm::dvec3(0.0);
  for (PlacedNode& node : nodes) node.to_world[3] -= glm::dvec4(centre, 0.0);
  return centre;
}

}  // namespace qtrace::gltf
