// Loads the buffers of a scene: BIN chunk, data URI, or a file that stays inside the scene's folder.
#pragma once

#include "engine/gltf_document/file.h"
#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <vector>

namespace qtrace::gltf {

// Each buffer has exactly its declared byteLength. Error where those in files together have more than
// `max_bytes`.
std::vector<tinygltf::Buffer> load_buffers(Source& source, const nlohmann::json& document,
                                           const std::filesystem::path& folder, FileContent content,
                                           std::size_t max_bytes);

}  // namespace qtrace::gltf
