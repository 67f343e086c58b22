// What surfaces are made of: glTF 2.0 metallic-roughness, and the extensions named below.
#pragma once

#include "engine/scene/texture.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace qtrace {

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

struct Material {
  std::string name;
  glm::vec3 base_color{1.0F};      // linear, in [0, 1]
  float metallic = 1.0F;           // in [0, 1]
  float roughness = 1.0F;          // perceptual, in [0, 1]; alpha of the microfacets = roughness^2
  float specular = 1.0F;           // strength of the dielectric lobe, in [0, 1]; 0 with metallic 0: Lambert
  glm::vec3 specular_color{1.0F};  // F0 tint of the dielectric lobe, >= 0 (KHR_materials_specular)
  glm::vec3 emission{0.0F};        // radiance, emissiveFactor * emissiveStrength, >= 0
  bool double_sided = false;       // emission leaves the back face too

  float ior = 1.5F;  // index of refraction of a dielectric, >= 1; 0: F0 of 1 (KHR_materials_ior)

  float opacity = 1.0F;  // of baseColorFactor, in [0, 1]; counts where alpha_mode says so
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5F;  // of `mask`: seen where the opacity is at least this

  float transmission =
      0.0F;  // share of the light that enters a dielectric and passes (KHR_materials_transmission)
  bool is_thin =
      true;  // light passes without refraction; else the surface bounds a volume (KHR_materials_volume)
  glm::vec3 attenuation_color{1.0F};  // what is left of white light after attenuation_distance in the volume
  float attenuation_distance = std::numeric_limits<float>::infinity();

  float clearcoat = 0.0F;            // in [0, 1] (KHR_materials_clearcoat)
  float clearcoat_roughness = 0.0F;  // as roughness

  bool is_unlit = false;  // emits its base colour to all sides and reflects nothing (KHR_materials_unlit)

  float normal_scale = 1.0F;                                   // of x and y of the normal texture
  float clearcoat_normal_scale = 1.0F;                         // likewise
  std::array<std::optional<Texture>, kTextureSlots> textures{};  // by TextureSlot

  const std::optional<Texture>& texture(TextureSlot slot) const {
    return textures[static_cast<std::size_t>(slot)];
  }
  std::optional<Texture>& texture(TextureSlot slot) { return textures[static_cast<std::size_t>(slot)]; }

  bool operator==(const Material&) const = default;
};

}  // namespace qtrace
