#include "engine/device_scene/material_table.h"

#include "engine/device_scene/vec4s.h"

#include <glm/common.hpp>

#include <glm/exponential.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace qtrace::gpu {
namespace {

// Of a dielectric at normal incidence (KHR_materials_ior; 1.5 in glTF 2.0, Appendix B). An index of 0 stands
// for one without bound.
float normal_reflectance(float ior) {
  if (ior == 1.5F) return 0.04F;
  const float root = ior == 0 ? 1.0F : (ior - 1) / (ior + 1);
  return root * root;
}

float cutoff_of(const qtrace::Material& m) {
  switch (m.alpha_mode) {
    case AlphaMode::mask:
      return m.alpha_cutoff;
    case AlphaMode::blend:
      return ALPHA_BLEND;
    case AlphaMode::opaque:
      break;
  }
  return ALPHA_OPAQUE;
}

float alpha_of(float roughness) { return roughness < LEAST_ROUGHNESS ? 0 : roughness * roughness; }

// KHR_materials_volume: what is left of white light after the attenuation distance.
vec4 absorption_of(const qtrace::Material& m) {
  constexpr float kLeastLeft = 1e-30F;  // of black, which absorbs all
  if (std::isinf(m.attenuation_distance)) return vec4(0);
  const glm::vec3 left = glm::max(m.attenuation_color, glm::vec3(kLeastLeft));
  return vec4(-glm::log(left) / m.attenuation_distance, 0);
}

// KHR_materials_specular: F0 = min(F0 of the index * colour, 1) * strength, F90 = strength.
gpu::Material pack_material(const qtrace::Material& m) {
  const glm::vec3 f0 = normal_reflectance(m.ior) * m.specular_color;
  gpu::Material packed{};
  packed.base_color = vec4(m.base_color, m.metallic);
  packed.emission = vec4(m.emission, m.double_sided ? EMITS_BOTH : EMITS_FRONT);
  packed.dielectric_f0 = vec4(glm::min(f0, glm::vec3(1.0F)) * m.specular, m.specular);
  packed.roughness = vec4(alpha_of(m.roughness), m.roughness, m.opacity, cutoff_of(m));
  packed.specular = vec4(f0, m.specular);
  packed.normal_scale = vec4(m.normal_scale, m.clearcoat_normal_scale, 0, 0);
  // An index without bound lets nothing in.
  const bool passes = m.transmission > 0 && m.ior > 0;
  packed.transmission = vec4(passes ? m.transmission : 0, passes && !m.is_thin ? m.ior : 0, 0, 0);
  packed.absorption = absorption_of(m);
  packed.coat = vec4(m.clearcoat, m.clearcoat_roughness, 0, 0);
  return packed;
}

// KHR_materials_unlit: it emits its base colour and reflects nothing.
gpu::Material pack_unlit(const qtrace::Material& m) {
  gpu::Material packed{};
  packed.emission = vec4(m.base_color, EMITS_UNLIT);
  packed.roughness = vec4(1, 1, m.opacity, cutoff_of(m));
  return packed;
}

// The element at which each slot's TextureUse begins.
void add_textures(gpu::Material& packed, const std::array<std::uint32_t, kTextureSlots>& uses,
                  std::size_t materials) {
  std::array<std::uint32_t, 12> elements{};
  elements.fill(NO_TEXTURE);
  const std::size_t first = materials * vec4s_of<gpu::Material>();
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    if (uses[slot] == NO_TEXTURE) continue;
    elements.at(slot) = static_cast<std::uint32_t>(first + uses[slot] * vec4s_of<TextureUse>());
  }
  static_assert(offsetof(gpu::Material, textures2) == offsetof(gpu::Material, textures0) + 2 * sizeof(uvec4));
  std::memcpy(&packed.textures0, elements.data(), sizeof(elements));
}

}  // namespace

std::vector<vec4> pack_materials(const Scene& scene, const TextureTable& textures) {
  std::vector<vec4> all;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const qtrace::Material& material = scene.materials[i];
    gpu::Material packed = material.is_unlit ? pack_unlit(material) : pack_material(material);
    add_textures(packed, textures.of[i], scene.materials.size());
    append_vec4s(all, packed);
  }
  for (const TextureUse& use : textures.uses) append_vec4s(all, use);
  return all;
}

}  // namespace qtrace::gpu
