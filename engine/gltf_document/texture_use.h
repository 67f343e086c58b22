// Which textures materials read, and what of vertices these need.
#pragma once

#include "engine/gltf_document/texture.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <set>
#include <vector>

namespace qtrace::gltf {

// Each for a document that has passed check_json().

// By material; none of materials that no primitive has. Where a factor of 0 makes a texture of no
// consequence, it is not read.
std::vector<std::vector<TextureUse>> texture_uses(const nlohmann::json& document);

std::set<std::size_t> used_images(const nlohmann::json& document,
                                  const std::vector<std::vector<TextureUse>>& uses);

bool reads_uv_set(const std::vector<TextureUse>& uses, std::size_t set);
// The texture of normals by whose coordinates tangents are turned; null where none is read.
const TextureUse* normal_texture(const std::vector<TextureUse>& uses);

}  // namespace qtrace::gltf
