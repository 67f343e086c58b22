// Tangents of triangles whose file has none.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace qtrace::gltf {

// What of `direction` is along a surface with that normal, of length 1; any direction along it where nothing
// is.
glm::dvec3 along_surface(const glm::dvec3& direction, const glm::dvec3& normal);

// Fills the tangents of triangles that all have attributes, from their texture coordinates of that set, after
// Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", whose rules glTF 2.0 names (section 3.7.2.1):
// those of corners at one position, with one normal and one texture coordinate, are averaged by the angles of
// their triangles, apart for mirrored and other coordinates. Triangles whose coordinates cover no area take
// the tangents of those that they share such corners with, or any.
void generate_tangents(std::span<const Triangle> triangles, std::size_t uv_set,
                       std::vector<TriangleAttributes>& attributes);

}  // namespace qtrace::gltf
