#include "engine/gltf_document/usage.h"

#include "engine/gltf_document/json.h"
#include "engine/gltf_document/texture_use.h"

#include <algorithm>
#include <array>
#include <string>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";

void add(const json& index, std::set<std::size_t>& used) {
  if (index.is_number_unsigned()) used.insert(index.get<std::size_t>());
}

using Uses = std::vector<TextureUse>;

// But those in `others`.
void add_attributes(const json& attributes, std::set<std::size_t>& used, const Uses& uses,
                    const json& others = {}) {
  for (const auto& item : attributes.items()) {
    const bool is_elsewhere = others.is_object() && others.contains(item.key());
    if (is_read_attribute(item.key(), uses) && !is_elsewhere) add(item.value(), used);
  }
}

const json& draco_of(const json& primitive) { return member(member(primitive, "extensions"), kDraco); }

// What Draco has compressed does not stand in accessors.
void add_primitive(const json& primitive, const std::vector<Uses>& materials, std::set<std::size_t>& used) {
  const json& material = member(primitive, "material");
  const Uses uses = material.is_null() ? Uses() : materials.at(material.get<std::size_t>());
  const json& draco = draco_of(primitive);
  add_attributes(member(primitive, "attributes"), used, uses, member(draco, "attributes"));
  for (const json& target : member(primitive, "targets")) add_attributes(target, used, uses);
  if (draco.is_null()) add(member(primitive, "indices"), used);
}

}  // namespace

bool is_read_attribute(const std::string& name, const Uses& uses) {
  constexpr std::array<std::string_view, 7> kRead{"POSITION",    "NORMAL",   "TEXCOORD_0", "COLOR_0",
                                                  "TRANSLATION", "ROTATION", "SCALE"};
  if (name == "TEXCOORD_1") return reads_uv_set(uses, 1);
  if (name == "TANGENT") return normal_texture(uses) != nullptr;
  return std::ranges::count(kRead, name) > 0 || name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
}

const json* meshopt_of(const json& view, const char** name) {
  const json& extensions = member(view, "extensions");
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const json& found = member(extensions, extension);
    if (found.is_null()) continue;
    if (name != nullptr) *name = extension;
    return &found;
  }
  return nullptr;
}

std::set<std::size_t> used_accessors(const json& document) {
  const std::vector<Uses> materials = texture_uses(document);
  std::set<std::size_t> used;
  for (const json& mesh : member(document, "meshes")) {
    for (const json& primitive : member(mesh, "primitives")) add_primitive(primitive, materials, used);
  }
  for (const json& skin : member(document, "skins")) add(member(skin, "inverseBindMatrices"), used);
  for (const json& node : member(document, "nodes")) {
    add_attributes(member(member(member(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes"), used,
                   {});
  }
  return used;
}

std::set<std::size_t> used_views(const json& document) {
  std::set<std::size_t> used;
  for (const std::size_t i : used_accessors(document)) {
    const json& accessor = document.at("accessors").at(i);
    const json& sparse = member(accessor, "sparse");
    add(member(accessor, "bufferView"), used);
    for (const char* part : {"indices", "values"}) add(member(member(sparse, part), "bufferView"), used);
  }
  for (const json& mesh : member(document, "meshes")) {
    for (const json& primitive : member(mesh, "primitives")) {
      add(member(draco_of(primitive), "bufferView"), used);
    }
  }
  for (const std::size_t i : used_images(document, texture_uses(document))) {
    add(member(document.at("images").at(i), "bufferView"), used);
  }
  return used;
}

std::vector<bool> buffers_that_are_read(const json& document) {
  std::vector<bool> is_read(member(document, "buffers").size());
  for (const std::size_t i : used_views(document)) {
    const json& view = document.at("bufferViews").at(i);
    const json* compressed = meshopt_of(view);
    is_read.at((compressed == nullptr ? view : *compressed).at("buffer").get<std::size_t>()) = true;
  }
  return is_read;
}

}  // namespace qtrace::gltf
