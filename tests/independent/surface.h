// What a ray finds: a point of a triangle, its normals, and what its material is there.
#pragma once

#include "engine/scene/scene.h"
#include "tests/independent/bvh.h"

#include <glm/vec3.hpp>

namespace qtrace::independent {

// Factors times textures, and times the colours of vertices where glTF says so.
struct Surface {
  glm::dvec3 base_color{1}, specular_color{1}, emission{0};
  double opacity = 1;
  double metallic = 1, roughness = 1, specular = 1;
  double transmission = 0;  // 0 as well where the index of refraction is none
  double clearcoat = 0, clearcoat_roughness = 0;
};

struct Point {
  glm::dvec3 position{0}, eye{0};  // eye: unit, towards where the ray came from
  glm::dvec3 face{0};              // geometric normal, on the side of the eye
  glm::dvec3 normal{0};            // of shading, on that side
  glm::dvec3 coat_normal{0};       // likewise, of the clearcoat
  bool from_front = true;
  const Material* material = nullptr;
  Surface surface;

  // Whether the eye is in the volume that the surface bounds.
  bool is_inside() const {
    return !from_front && !material->is_thin && material->transmission > 0 && material->ior > 0;
  }
};

Point point_at(const Scene& scene, const Hit& hit, const glm::dvec3& position, const glm::dvec3& eye);

// The chance that a ray that meets the triangle there does not pass: 0 or 1 but for AlphaMode::blend.
double chance_to_stop(const Scene& scene, const Hit& hit);

// Radiance that a surface emits, before a face or a clearcoat holds it back.
glm::dvec3 emission_at(const Scene& scene, const Hit& hit);

}  // namespace qtrace::independent
