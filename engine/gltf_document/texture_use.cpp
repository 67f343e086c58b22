#include "engine/gltf_document/texture_use.h"

#include "engine/gltf_document/json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

// Where a texture stands in a material, and the factor before it.
struct Place {
  TextureSlot slot;
  std::string_view owner;  // a member of the material, or an extension; empty: the material itself
  std::string_view property;
  std::string_view factor = {};
  double default_factor = 1;
};

constexpr std::string_view kPbr = "pbrMetallicRoughness", kSpecular = "KHR_materials_specular",
                           kTransmission = "KHR_materials_transmission",
                           kClearcoat = "KHR_materials_clearcoat";

constexpr std::array<Place, kTextureSlots> kPlaces{{
    {TextureSlot::base_color, kPbr, "baseColorTexture"},
    {TextureSlot::metallic_roughness, kPbr, "metallicRoughnessTexture"},
    {TextureSlot::normal, "", "normalTexture"},
    {TextureSlot::emission, "", "emissiveTexture", "emissiveFactor", 0},
    {TextureSlot::specular, kSpecular, "specularTexture", "specularFactor", 1},
    {TextureSlot::specular_color, kSpecular, "specularColorTexture", "specularFactor", 1},
    {TextureSlot::transmission, kTransmission, "transmissionTexture", "transmissionFactor", 0},
    {TextureSlot::clearcoat, kClearcoat, "clearcoatTexture", "clearcoatFactor", 0},
    {TextureSlot::clearcoat_roughness, kClearcoat, "clearcoatRoughnessTexture", "clearcoatFactor", 0},
    {TextureSlot::clearcoat_normal, kClearcoat, "clearcoatNormalTexture", "clearcoatFactor", 0},
}};

double number(const json& object, std::string_view name, double otherwise) {
  const json& value = member(object, name);
  return value.is_number() ? value.get<double>() : otherwise;
}

const json& owner_of(const json& material, const Place& place) {
  if (place.owner.empty()) return material;
  return place.owner == kPbr ? member(material, kPbr) : member(member(material, "extensions"), place.owner);
}

bool is_seen(const json& owner, const Place& place) {
  const json& factor = member(owner, place.factor);
  if (!factor.is_array()) return number(owner, place.factor, place.default_factor) != 0;
  return std::ranges::any_of(factor, [](const json& value) { return value != 0; });
}

// KHR_texture_transform: translation * rotation * scale. Angles grow counter-clockwise as one sees an image
// whose v points down, which the extension's words say and its listing of GLSL does not
// (github.com/KhronosGroup/glTF/issues/1563); its sample model and the viewers follow the words.
glm::mat3x2 transform_of(const json& transform) {
  const double angle = number(transform, "rotation", 0);
  const json offset = transform.value("offset", json{0, 0}), scale = transform.value("scale", json{1, 1});
  const double c = std::cos(angle), s = std::sin(angle);
  const auto x = scale[0].get<double>(), y = scale[1].get<double>();
  return {x * c, -x * s, y * s, y * c, offset[0].get<double>(), offset[1].get<double>()};
}

TextureUse use_of(const json& texture, const Place& place) {
  TextureUse use;
  use.slot = place.slot;
  use.property = place.property;
  use.texture = texture.at("index").get<std::size_t>();
  use.uv_set = texture.value("texCoord", std::size_t{0});
  use.scale = static_cast<float>(number(texture, "scale", 1));
  const json& transform = member(member(texture, "extensions"), "KHR_texture_transform");
  if (!transform.is_object()) return use;
  use.uv_set = transform.value("texCoord", use.uv_set);
  use.image_from_uv = transform_of(transform);
  return use;
}

std::vector<TextureUse> uses_of(const json& material) {
  const bool is_unlit = member(material, "extensions").contains("KHR_materials_unlit");
  std::vector<TextureUse> uses;
  for (const Place& place : kPlaces) {
    const json& owner = owner_of(material, place);
    const json& texture = member(owner, place.property);
    const bool counts = !is_unlit || place.slot == TextureSlot::base_color;
    if (counts && texture.is_object() && is_seen(owner, place)) uses.push_back(use_of(texture, place));
  }
  return uses;
}

}  // namespace

std::vector<std::vector<TextureUse>> texture_uses(const json& document) {
  const json& materials = member(document, "materials");
  std::vector<std::vector<TextureUse>> uses(materials.size());
  std::set<std::size_t> seen;
  for (const json& mesh : member(document, "meshes")) {
    for (const json& primitive : member(mesh, "primitives")) {
      const json& index = member(primitive, "material");
      if (index.is_null()) continue;
      const auto material = index.get<std::size_t>();
      if (seen.insert(material).second) uses.at(material) = uses_of(materials[material]);
    }
  }
  return uses;
}

std::set<std::size_t> used_images(const json& document, const std::vector<std::vector<TextureUse>>& uses) {
  std::set<std::size_t> images;
  for (const std::vector<TextureUse>& material : uses) {
    for (const TextureUse& use : material) {
      const json& source = member(document.at("textures").at(use.texture), "source");
      if (!source.is_null()) images.insert(source.get<std::size_t>());
    }
  }
  return images;
}

bool reads_uv_set(const std::vector<TextureUse>& uses, std::size_t set) {
  return std::ranges::any_of(uses, [set](const TextureUse& use) { return use.uv_set == set; });
}

const TextureUse* normal_texture(const std::vector<TextureUse>& uses) {
  for (const TextureSlot slot : {TextureSlot::normal, TextureSlot::clearcoat_normal}) {
    const auto found = std::ranges::find(uses, slot, &TextureUse::slot);
    if (found != uses.end()) return &*found;
  }
  return nullptr;
}

}  // namespace qtrace::gltf
