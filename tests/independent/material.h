// Reflection and transmission, word for word after glTF 2.0, appendix B, and the extensions
// KHR_materials_ior, _specular, _transmission, _volume and _clearcoat.
#pragma once

#include "tests/independent/surface.h"

#include <glm/vec3.hpp>

#include <optional>

namespace qtrace::independent {

// Below this roughness a lobe has one direction only.
inline constexpr double kSmooth = 0.005;

bool has_diffuse(const Point& p);
bool has_reflection(const Point& p);  // the microfacets' or, smooth, the mirror's
bool has_transmission(const Point& p);
bool has_coat(const Point& p);
bool has_one_reflection(const Point& p);
bool has_one_transmission(const Point& p);
bool has_one_coat_reflection(const Point& p);

// The microfacet distribution about the normal, per steradian of microfacets.
double facet_distribution(double roughness, double n_h);

// Share of the light that the clearcoat reflects, at the eye's angle; 0 where there is none.
double coat_share(const Point& p);

// Indices of refraction on the eye's side and beyond; 1 both where light passes without refraction.
struct Indices {
  double eye = 1, beyond = 1;
};
Indices indices(const Point& p);

// The facet that refracts one direction into the other, on the side of the shading normal; none if no facet
// does.
std::optional<glm::dvec3> refracting_facet(const Point& p, const glm::dvec3& to_light);

// By Snell's law, with the index on the eye's side over the one beyond; none under total reflection.
std::optional<glm::dvec3> refracted(const glm::dvec3& eye, const glm::dvec3& facet, double index_ratio);

// On the other side of the surface, at the same angle.
glm::dvec3 mirrored_at_plane(const Point& p, const glm::dvec3& direction);

// f(to_light, to_eye) times the cosine of to_light to its lobe's normal, of all lobes with more than one
// direction. Directions count only where shading normals and the face agree about their side.
glm::dvec3 scattered_part(const Point& p, const glm::dvec3& to_light);

// The one direction of a smooth lobe, and the part of the radiance from there that reaches the eye.
struct OneDirection {
  glm::dvec3 direction{0};
  glm::dvec3 part{0};  // black where normals disagree about the side, or nothing passes
};
OneDirection reflected_part(const Point& p);
OneDirection transmitted_part(const Point& p);
OneDirection coat_part(const Point& p);

// Reflectances at the shading normal and the eye's angle, to choose lobes by; in [0, 1].
double reflectance_estimate(const Point& p);

}  // namespace qtrace::independent
