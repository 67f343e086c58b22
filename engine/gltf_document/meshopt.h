// Buffer views that are compressed with meshoptimizer (EXT_meshopt_compression, KHR_meshopt_compression).
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

namespace qtrace::gltf {

// Gives each compressed bufferView that is used the bytes that it stands for. Error where these cannot be
// decoded, or where all of them would have more than `max_bytes`. The document has passed check_json().
void decode_meshopt(const Source& source, nlohmann::json& document, std::vector<tinygltf::Buffer>& buffers,
                    std::size_t max_bytes);

}  // namespace qtrace::gltf
