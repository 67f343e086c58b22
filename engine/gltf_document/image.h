// Finds the images that materials read.
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace qtrace::gltf {

// Appends the bytes of images that stand in files and data URIs to `buffers`; those of others lie there.
// Error for an image that a material reads and that has no bytes, or is of a kind that cannot be decoded and
// without another in its place, and where images in files have more than `max_bytes`. The document has passed
// check_json(), and its compressed bufferViews are decoded.
Textures find_textures(Source& source, const nlohmann::json& document, std::vector<tinygltf::Buffer>& buffers,
                       const std::filesystem::path& folder, std::size_t max_bytes);

}  // namespace qtrace::gltf
