// Primitives that are compressed with Draco (KHR_draco_mesh_compression).
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

namespace qtrace::gltf {

// Gives each compressed primitive accessors of its own with the data that it stands for. Error where that
// cannot be decoded, or where all of it would have more than `max_bytes`. The document has passed
// check_json().
void decode_draco(const Source& source, nlohmann::json& document, std::vector<tinygltf::Buffer>& buffers,
                  std::size_t max_bytes);

}  // namespace qtrace::gltf
