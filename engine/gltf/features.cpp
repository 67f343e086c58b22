#include "engine/gltf/features.h"

#include <algorithm>
#include <array>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view kLights = "KHR_lights_punctual";
constexpr std::string_view kDraco = "KHR_draco_mesh_compression";
constexpr std::array<std::string_view, 2> kSupported{"KHR_materials_emissive_strength",
                                                     "KHR_materials_specular"};

bool is_supported(const std::string& extension) {
  return std::find(kSupported.begin(), kSupported.end(), extension) != kSupported.end();
}

const json& member(const json& object, std::string_view name) {
  static const json nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

std::string item_label(std::string_view kind, std::size_t index, const json& item) {
  return label(kind, index, item.value("name", ""));
}

void check_extensions(Source& source, const json& document, bool names_lights) {
  for (const json& required : member(document, "extensionsRequired")) {
    const auto name = required.get<std::string>();
    source.check(is_supported(name), "the required extension {} is not supported; supported are {}", name,
                 joined(kSupported, " and "));
  }
  for (const json& used : member(document, "extensionsUsed")) {
    const auto name = used.get<std::string>();
    if (is_supported(name) || (name == kLights && names_lights)) continue;
    source.warn("extension {} is not modelled; the scene is read without it", name);
  }
}

void check_buffer_views(const Source& source, const json& views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const std::string_view name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      source.check(!member(views[i], "extensions").contains(name),
                   "bufferView {} is compressed with {}; uncompressed data would be right", i, name);
    }
  }
}

// Here and not where accessors are read: tinygltf would refuse some of these without naming the place.
void check_dense(const Source& source, const json& document, const std::string& place,
                 const json& accessor_index) {
  if (accessor_index.is_null()) return;
  const auto index = accessor_index.get<std::size_t>();
  const json& accessor = document["accessors"][index];
  source.check(!accessor.contains("sparse"),
               "{}: accessor {} is sparse, which is not supported; a dense accessor would be right", place,
               index);
  source.check(accessor.contains("bufferView"),
               "{}: accessor {} has no bufferView; one that holds its data would be right", place, index);
}

void check_mesh(Source& source, const json& document, const std::string& mesh, const json& primitives) {
  bool has_targets = false;
  bool has_colors = false;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const json& primitive = primitives[i];
    const std::string place = fmt::format("{} primitive {}", mesh, i);
    source.check(!member(primitive, "extensions").contains(kDraco),
                 "{} is compressed with {}; uncompressed data would be right", place, kDraco);
    check_dense(source, document, place, member(primitive, "indices"));
    for (const std::string_view name : {"POSITION", "NORMAL", "TEXCOORD_0"}) {
      check_dense(source, document, place, member(primitive["attributes"], name));
    }
    has_targets = has_targets || !member(primitive, "targets").empty();
    has_colors = has_colors || primitive["attributes"].contains("COLOR_0");
  }
  if (has_targets) source.warn("{}: morph targets are not modelled; the base shape is used", mesh);
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
  check_buffer_views(source, member(document, "bufferViews"));
  const json& meshes = member(document, "meshes");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    check_mesh(source, document, item_label("mesh", i, meshes[i]), member(meshes[i], "primitives"));
  }
  warn_by_name(source, "skin", member(document, "skins"), "its meshes keep their bind pose");
  warn_by_name(source, "animation", member(document, "animations"), "nodes keep their own transforms");
  warn_by_name(source, "light", lights,
               "KHR_lights_punctual is not supported and emissive materials are the only lights");
}

}  // namespace qtrace::gltf
