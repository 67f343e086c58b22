#include "engine/gltf_document/features.h"

#include "engine/gltf_document/support.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view kLights = "KHR_lights_punctual";
constexpr std::string_view kIor = "KHR_materials_ior";
constexpr std::string_view kQuantization = "KHR_mesh_quantization";

std::string extensions_to_require() {
  std::string names;
  for (const Support& row : kSupport) {
    const bool is_extension = row.name.starts_with("KHR_") || row.name.starts_with("EXT_");
    if (is_extension && may_be_required(row.treatment)) {
      names.append(names.empty() ? "" : ", ").append(row.name);
    }
  }
  return names;
}

const json& member(const json& object, std::string_view name) {
  static const json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

std::string item_label(std::string_view kind, std::size_t index, const json& item) {
  const json& name = member(item, "name");
  return label(kind, index, name.is_string() ? name.get<std::string>() : "");
}

// The names of all extensions that stand somewhere, at any depth that parse_json() lets files nest; not in
// extras.
void add_extensions(const json& value, std::set<std::string>& names) {
  if (!value.is_structured()) return;
  for (const auto& [key, member] : value.items()) {
    if (value.is_object() && key == "extras") continue;
    if (value.is_object() && key == "extensions" && member.is_object()) {
      for (const auto& extension : member.items()) names.insert(extension.key());
    }
    add_extensions(member, names);
  }
}

double number_of(const json& object, std::string_view name, double otherwise) {
  const json& value = member(object, name);
  return value.is_number() ? value.get<double>() : otherwise;
}

// Whether the index of refraction of KHR_materials_ior is another than the default, and a dielectric reflects
// by it.
bool needs_ior(const json& material) {
  const json& extensions = member(material, "extensions");
  const bool is_default = number_of(member(extensions, kIor), "ior", 1.5) == 1.5;
  const bool is_dielectric = number_of(member(material, "pbrMetallicRoughness"), "metallicFactor", 1) < 1;
  const bool reflects = number_of(member(extensions, "KHR_materials_specular"), "specularFactor", 1) > 0;
  return !is_default && is_dielectric && reflects;
}

// Whether the picture is as the file says, as far as this extension goes.
bool shows_in_full(const json& document, const std::string& extension) {
  const bool is_ior_unseen =
      extension == kIor && std::ranges::none_of(member(document, "materials"), needs_ior);
  return is_ior_unseen || shows_in_full(treatment_of(extension));
}

void check_extensions(Source& source, const json& document, bool names_lights) {
  for (const json& required : member(document, "extensionsRequired")) {
    const auto name = required.get<std::string>();
    source.check(may_be_required(treatment_of(name)),
                 "the required extension {} is not supported; supported are {}", name,
                 extensions_to_require());
  }
  std::set<std::string> declared;
  for (const json& used : member(document, "extensionsUsed")) {
    const auto name = used.get<std::string>();
    declared.insert(name);
    if (shows_in_full(document, name) || (name == kLights && names_lights)) continue;
    source.warn("extension {} is not modelled; the scene is read without it", name);
  }
  std::set<std::string> undeclared;
  add_extensions(document, undeclared);
  for (const std::string& name : undeclared) {
    if (declared.contains(name)) continue;
    source.warn("extension {} is used but not declared in extensionsUsed; {}", name,
                shows_in_full(document, name) ? "it is read as if it were"
                                              : "it is not modelled, and the scene is read without it");
  }
}

// Whether an attribute is of a type that glTF has by that extension alone.
bool is_quantized(const json& document, const json& attributes, std::string_view name) {
  const json& index = member(attributes, name);
  if (!index.is_number_unsigned()) return false;
  const json& accessor = document["accessors"][index.get<std::size_t>()];
  const int type = accessor.value("componentType", 0);
  if (type == TINYGLTF_COMPONENT_TYPE_FLOAT) return false;
  const bool is_unsigned =
      type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  return !(name == "TEXCOORD_0" && is_unsigned && accessor.value("normalized", false));
}

void check_quantization(Source& source, const json& document, const std::string& mesh,
                        const json& primitives) {
  const json& declared = member(document, "extensionsUsed");
  if (std::ranges::count(declared, json(kQuantization)) > 0) return;
  for (const json& primitive : primitives) {
    for (const std::string_view name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
      if (!is_quantized(document, primitive["attributes"], name)) continue;
      source.warn(
          "{}: {} has integers as {} allows, which extensionsUsed does not declare; it is read as if it did",
          mesh, name, kQuantization);
      return;
    }
  }
}

void warn_of_colors(Source& source, const std::string& mesh, const json& primitives) {
  const bool has_colors = std::ranges::any_of(
      primitives, [](const json& primitive) { return primitive["attributes"].contains("COLOR_0"); });
  if (has_colors) source.warn("{}: vertex colours (COLOR_0) are not modelled; they are ignored", mesh);
}

void warn_by_name(Source& source, std::string_view kind, const json& items, std::string_view consequence) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    source.warn("{} is not modelled; {}", item_label(kind, i, items[i]), consequence);
  }
}

}  // namespace

void check_features(Source& source, const json& document) {
  const json& lights = member(member(member(document, "extensions"), kLights), "lights");
  check_extensions(source, document, !lights.empty());
  const json& meshes = member(document, "meshes");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::string mesh = item_label("mesh", i, meshes[i]);
    const json& primitives = member(meshes[i], "primitives");
    warn_of_colors(source, mesh, primitives);
    check_quantization(source, document, mesh, primitives);
  }
  warn_by_name(source, "animation", member(document, "animations"), "nodes keep their own transforms");
  warn_by_name(source, "light", lights,
               "KHR_lights_punctual is not supported and emissive materials are the only lights");
}

}  // namespace qtrace::gltf
