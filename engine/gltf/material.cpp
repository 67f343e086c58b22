#include "engine/gltf/material.h"

#include "engine/gltf/factors.h"

#include <algorithm>

namespace qtrace::gltf {
namespace {

// Of emitted radiance. A film sums squares of radiance over up to a million frames in single precision, which
// ends at 3e38.
constexpr float kMostEmission = 1e12F;

void read_emission(Source& source, const tinygltf::Material& file, const Factors& factors,
                   Material& material) {
  const float strength =
      factors.scalar_of("KHR_materials_emissive_strength", "emissiveStrength", 1, kNoLimit);
  const glm::vec3 factor = factors.rgb("emissiveFactor", file.emissiveFactor, kNoLimit);
  material.emission = strength * factor;
  for (int c = 0; c < 3; ++c) {
    source.check(material.emission[c] <= kMostEmission,
                 "{}: emits {:g}, emissiveFactor times emissiveStrength; up to {:g} would be right",
                 factors.material(), static_cast<double>(factor[c]) * static_cast<double>(strength),
                 kMostEmission);
  }
  if (std::max({factor.r, factor.g, factor.b}) > 1) {
    source.warn("{}: emissiveFactor is {:g} {:g} {:g}, where glTF ends at 1; it is read as it stands",
                factors.material(), factor.r, factor.g, factor.b);
  }
}

// Where a surface is opaque, what the file says of its opacity is of no consequence.
void read_opacity(const tinygltf::Material& file, const Factors& factors, Material& material) {
  const float opacity = factors.scalar("baseColorFactor", file.pbrMetallicRoughness.baseColorFactor[3], 1);
  const float cutoff = factors.scalar("alphaCutoff", file.alphaCutoff, kNoLimit);
  if (file.alphaMode == "OPAQUE") return;
  material.opacity = opacity;
  material.alpha_mode = file.alphaMode == "MASK" ? AlphaMode::mask : AlphaMode::blend;
  if (material.alpha_mode == AlphaMode::mask) material.alpha_cutoff = cutoff;
}

void read_dielectric(Source& source, const Factors& factors, Material& material) {
  const double ior = factors.number("KHR_materials_ior", "ior", 1.5);
  source.check(ior == 0 || ior >= 1, "{}: ior is {}; 1 or more, or 0, would be right", factors.material(),
               ior);
  material.ior = static_cast<float>(ior);
  material.specular = factors.scalar_of("KHR_materials_specular", "specularFactor", 1, 1);
  material.specular_color = factors.rgb_of("KHR_materials_specular", "specularColorFactor", kNoLimit);
}

// A volume without light in it is not seen. How thick it is, the path finds out (KHR_materials_volume); the
// factor only says whether there is one.
void read_transmission(Source& source, const Factors& factors, Material& material) {
  const std::string volume = "KHR_materials_volume";
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  material.transmission = factors.scalar_of("KHR_materials_transmission", "transmissionFactor", 0, 1);
  const float thickness = factors.scalar_of(volume, "thicknessFactor", 0, kNoLimit);
  const glm::vec3 color = factors.rgb_of(volume, "attenuationColor", 1);
  const auto distance = static_cast<float>(factors.number(volume, "attenuationDistance", kInfinity));
  source.check(distance > 0, "{}: attenuationDistance is {}; a number above 0 would be right",
               factors.material(), distance);
  if (material.transmission == 0 || thickness == 0) return;
  material.is_thin = false;
  material.attenuation_color = color;
  material.attenuation_distance = distance;
}

void read_clearcoat(const Factors& factors, Material& material) {
  const std::string extension = "KHR_materials_clearcoat";
  material.clearcoat = factors.scalar_of(extension, "clearcoatFactor", 0, 1);
  material.clearcoat_roughness = factors.scalar_of(extension, "clearcoatRoughnessFactor", 0, 1);
}

// KHR_materials_unlit: its colour and opacity are all that counts.
Material unlit(const Material& lit) {
  Material material;
  material.name = lit.name;
  material.base_color = lit.base_color;
  material.double_sided = lit.double_sided;
  material.opacity = lit.opacity;
  material.alpha_mode = lit.alpha_mode;
  material.alpha_cutoff = lit.alpha_cutoff;
  material.is_unlit = true;
  return material;
}

Material read_material(Source& source, std::size_t index) {
  const tinygltf::Material& file = source.model.materials[index];
  const tinygltf::PbrMetallicRoughness& pbr = file.pbrMetallicRoughness;
  const std::string name = label("material", index, file.name);
  const Factors factors(source, file, name);
  Material material;
  material.name = file.name.empty() ? name : file.name;
  material.base_color = factors.rgb("baseColorFactor", pbr.baseColorFactor, 1);
  material.metallic = factors.scalar("metallicFactor", pbr.metallicFactor, 1);
  material.roughness = factors.scalar("roughnessFactor", pbr.roughnessFactor, 1);
  material.double_sided = file.doubleSided;
  read_opacity(file, factors, material);
  read_dielectric(source, factors, material);
  read_transmission(source, factors, material);
  read_clearcoat(factors, material);
  read_emission(source, file, factors, material);
  return factors.has("KHR_materials_unlit") ? unlit(material) : material;
}

}  // namespace

std::vector<Material> read_materials(Source& source) {
  std::vector<Material> materials;
  for (std::size_t i = 0; i < source.model.materials.size(); ++i) {
    materials.push_back(read_material(source, i));
  }
  return materials;
}

}  // namespace qtrace::gltf
