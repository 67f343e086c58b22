// Normals out of textures.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace qtrace::independent {

// glTF 2.0, "Additional Textures": value is the texture's, in [0, 1]; normal is unit, and tangent.w tells the
// side of the bitangent. The normal itself where value or tangent have no direction.
glm::dvec3 mapped_normal(const glm::dvec3& value, double scale, const glm::dvec3& normal,
                         const glm::dvec4& tangent);

// Keller et al. 2017, "The Iray Light Transport Simulation and Rendering System", A.3: the normal turned
// towards the eye as far as the mirror's direction needs to leave the surface. `face` is on the eye's side.
glm::dvec3 adapted_normal(const glm::dvec3& normal, const glm::dvec3& face, const glm::dvec3& eye);

}  // namespace qtrace::independent
