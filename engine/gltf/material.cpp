#include "engine/gltf/material.h"

#include <algorithm>
#include <limits>

namespace qtrace::gltf {
namespace {

constexpr float kNoLimit = std::numeric_limits<float>::max();

// Numbers of one material, checked; messages name it.
class Factors {
 public:
  Factors(Source& source, std::string material) : source_(source), material_(std::move(material)) {}

  float scalar(std::string_view property, double value, float max) const {
    constexpr double kRounding = 1e-5;  // so far beyond the limits, it is clear what was meant
    const auto most = static_cast<double>(max);
    source_.check(value >= -kRounding && value <= most + kRounding, "{}: {} is {}; {} would be right",
                  material_, property, value, max < kNoLimit ? fmt::format("0 to {}", max) : "0 or more");
    const double meant = std::clamp(value, 0.0, most);
    if (meant != value) source_.warn("{}: {} is {}; it is read as {}", material_, property, value, meant);
    return static_cast<float>(meant);
  }

  glm::vec3 rgb(std::string_view property, const std::vector<double>& value, float max) const {
    return {scalar(property, value[0], max), scalar(property, value[1], max),
            scalar(property, value[2], max)};
  }

  const std::string& material() const { return material_; }

 private:
  Source& source_;
  std::string material_;
};

const tinygltf::Value* find_property(const tinygltf::Material& material, const std::string& extension,
                                     const std::string& property) {
  const auto found = material.extensions.find(extension);
  const bool is_there = found != material.extensions.end() && found->second.Has(property);
  return is_there ? &found->second.Get(property) : nullptr;
}

void read_specular(const tinygltf::Material& file, const Factors& factors, Material& material) {
  const std::string extension = "KHR_materials_specular";
  if (const tinygltf::Value* value = find_property(file, extension, "specularFactor")) {
    material.specular = factors.scalar("specularFactor", value->GetNumberAsDouble(), 1);
  }
  if (const tinygltf::Value* value = find_property(file, extension, "specularColorFactor")) {
    const std::vector<double> color{value->Get(0).GetNumberAsDouble(), value->Get(1).GetNumberAsDouble(),
                                    value->Get(2).GetNumberAsDouble()};
    material.specular_color = factors.rgb("specularColorFactor", color, kNoLimit);
  }
}

// Of emitted radiance. A film sums squares of radiance over up to a million frames in single precision, which
// ends at 3e38.
constexpr float kMostEmission = 1e12F;

void read_emission(Source& source, const tinygltf::Material& file, const Factors& factors,
                   Material& material) {
  const tinygltf::Value* value = find_property(file, "KHR_materials_emissive_strength", "emissiveStrength");
  const float strength =
      value == nullptr ? 1 : factors.scalar("emissiveStrength", value->GetNumberAsDouble(), kNoLimit);
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
  if (file.emissiveTexture.index >= 0 && material.emission != glm::vec3(0)) {
    source.warn(
        "{}: emits nothing, as its emissiveTexture is not modelled, and the factor alone would make a lamp "
        "of all of its surface",
        factors.material());
    material.emission = glm::vec3(0);
  }
}

void warn_of_textures(Source& source, const tinygltf::Material& file, const std::string& name) {
  std::vector<std::string_view> slots;
  const auto note = [&](int index, const char* slot) {
    if (index >= 0) slots.emplace_back(slot);
  };
  note(file.pbrMetallicRoughness.baseColorTexture.index, "baseColorTexture");
  note(file.pbrMetallicRoughness.metallicRoughnessTexture.index, "metallicRoughnessTexture");
  note(file.normalTexture.index, "normalTexture");
  note(file.occlusionTexture.index, "occlusionTexture");
  for (const char* slot : {"specularTexture", "specularColorTexture"}) {
    if (find_property(file, "KHR_materials_specular", slot) != nullptr) slots.emplace_back(slot);
  }
  if (slots.empty()) return;
  source.warn("{}: {} {} not modelled; the factors alone are used", name, joined(slots, ", "),
              slots.size() == 1 ? "is" : "are");
}

Material read_material(Source& source, std::size_t index) {
  const tinygltf::Material& file = source.model.materials[index];
  const tinygltf::PbrMetallicRoughness& pbr = file.pbrMetallicRoughness;
  const std::string name = label("material", index, file.name);
  const Factors factors(source, name);
  Material material;
  material.name = file.name.empty() ? name : file.name;
  material.base_color = factors.rgb("baseColorFactor", pbr.baseColorFactor, 1);
  factors.scalar("baseColorFactor", pbr.baseColorFactor[3], 1);
  material.metallic = factors.scalar("metallicFactor", pbr.metallicFactor, 1);
  material.roughness = factors.scalar("roughnessFactor", pbr.roughnessFactor, 1);
  material.double_sided = file.doubleSided;
  read_specular(file, factors, material);
  read_emission(source, file, factors, material);
  warn_of_textures(source, file, name);
  if (file.alphaMode != "OPAQUE") {
    source.warn("{}: alphaMode {} is not modelled; the material is opaque", name, file.alphaMode);
  }
  return material;
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
