// Reflection, word for word after glTF 2.0, appendix B, and KHR_materials_specular.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

namespace qtrace::independent {

// Whether a material has the microfacet lobe.
bool has_lobe(const Material& material);

// The microfacet distribution about the normal, per steradian of microfacets.
double facet_distribution(const Material& material, double n_h);

// f_r(to_light, to_eye) about the unit normal n; per steradian. Both directions unit and above the surface.
glm::dvec3 reflect(const Material& material, const glm::dvec3& n, const glm::dvec3& to_light,
                   const glm::dvec3& to_eye);

}  // namespace qtrace::independent
