// What of a document the loader reads. The rest may be missing or broken: it changes nothing.
#pragma once

#include "engine/gltf_document/texture.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace qtrace::gltf {

// An attribute of primitives or instances that the loader reads, such as POSITION or JOINTS_1. `uses`: the
// textures of the primitive's material, which alone need some of them.
bool is_read_attribute(const std::string& name, const std::vector<TextureUse>& uses);

// Each for a document that has passed check_json().
// Those of meshes, skins and instances.
std::set<std::size_t> used_accessors(const nlohmann::json& document);
// Those of the used accessors, of compressed primitives and of images that materials read.
std::set<std::size_t> used_views(const nlohmann::json& document);
// For each buffer. A compressed view reads the buffer with its compressed bytes; the one that it stands for
// may have none.
std::vector<bool> buffers_that_are_read(const nlohmann::json& document);

// The extension by which meshoptimizer compressed a buffer view; null if it did not. `name` becomes the
// extension's.
const nlohmann::json* meshopt_of(const nlohmann::json& view, const char** name = nullptr);

}  // namespace qtrace::gltf
