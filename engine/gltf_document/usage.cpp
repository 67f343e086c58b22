#include "engine/gltf_document/usage.h"

#include <algorithm>
#include <array>
#include <string>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";

const json& member(const json& object, const char* name) {
  static const json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

void add(const json& index, std::set<std::size_t>& used) {
  if (index.is_number_unsigned()) used.insert(index.get<std::size_t>());
}

// But those in `others`.
void add_attributes(const json& attributes, std::set<std::size_t>& used, const json& others = {}) {
  for (const auto& item : attributes.items()) {
    const bool is_elsewhere = others.is_object() && others.contains(item.key());
    if (is_read_attribute(item.key()) && !is_elsewhere) add(item.value(), used);
  }
}

const json& draco_of(const json& primitive) { return member(member(primitive, "extensions"), kDraco); }

// What Draco has compressed does not stand in accessors.
void add_primitive(const json& primitive, std::set<std::size_t>& used) {
  const json& draco = draco_of(primitive);
  add_attributes(member(primitive, "attributes"), used, member(draco, "attributes"));
  for (const json& target : member(primitive, "targets")) add_attributes(target, used);
  if (draco.is_null()) add(member(primitive, "indices"), used);
}

}  // namespace

bool is_read_attribute(const std::string& name) {
  constexpr std::array<std::string_view, 6> kRead{"POSITION",    "NORMAL",   "TEXCOORD_0",
                                                  "TRANSLATION", "ROTATION", "SCALE"};
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
  std::set<std::size_t> used;
  for (const json& mesh : member(document, "meshes")) {
    for (const json& primitive : member(mesh, "primitives")) add_primitive(primitive, used);
  }
  for (const json& skin : member(document, "skins")) add(member(skin, "inverseBindMatrices"), used);
  for (const json& node : member(document, "nodes")) {
    add_attributes(member(member(member(node, "extensions"), "EXT_mesh_gpu_instancing"), "attributes"), used);
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
