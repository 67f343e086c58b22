#include "engine/gltf_document/features.h"

#include "engine/gltf_document/json.h"
#include "engine/gltf_document/support.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

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

void check_extensions(Source& source, const json& document) {
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
    if (shows_in_full(treatment_of(name))) continue;
    source.warn("extension {} is not modelled; the scene is read without it", name);
  }
  std::set<std::string> undeclared;
  add_extensions(document, undeclared);
  for (const std::string& name : undeclared) {
    if (declared.contains(name)) continue;
    source.warn("extension {} is used but not declared in extensionsUsed; {}", name,
                shows_in_full(treatment_of(name)) ? "it is read as if it were"
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
  return !(name.starts_with("TEXCOORD_") && is_unsigned && accessor.value("normalized", false));
}

void check_quantization(Source& source, const json& document, const std::string& mesh,
                        const json& primitives) {
  const json& declared = member(document, "extensionsUsed");
  if (std::ranges::count(declared, json(kQuantization)) > 0) return;
  for (const json& primitive : primitives) {
    for (const std::string_view name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1"}) {
      if (!is_quantized(document, primitive["attributes"], name)) continue;
      source.warn(
          "{}: {} has integers as {} allows, which extensionsUsed does not declare; it is read as if it did",
          mesh, name, kQuantization);
      return;
    }
  }
}

}  // namespace

void check_features(Source& source, const json& document) {
  check_extensions(source, document);
  const json& meshes = member(document, "meshes");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::string mesh = item_label("mesh", i, meshes[i]);
    const json& primitives = member(meshes[i], "primitives");
    check_quantization(source, document, mesh, primitives);
  }
  const json& animations = member(document, "animations");
  for (std::size_t i = 0; i < animations.size(); ++i) {
    source.warn("{} is not modelled; nodes keep their own transforms",
                item_label("animation", i, animations[i]));
  }
}

}  // namespace qtrace::gltf
