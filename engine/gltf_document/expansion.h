// Accessors whose data is not simply there: sparse ones, and those without a bufferView.
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace qtrace::gltf {

// The bytes of a bufferView. Error where they lie outside their buffer.
std::span<const unsigned char> view_bytes(const Source& source, const nlohmann::json& document,
                                          const std::vector<tinygltf::Buffer>& buffers, std::size_t view);

// Appends a buffer with a bufferView of all of it, and returns the bufferView's index.
std::size_t add_view(nlohmann::json& document, std::vector<tinygltf::Buffer>& buffers,
                     std::vector<unsigned char> bytes);

// Gives each accessor that a mesh, a skin or an instance uses a dense bufferView of its own where it has
// none: zeros without a bufferView (glTF 2.0, 3.6.2.1), and with the elements of a sparse one put in. Error
// where these lie outside their bufferViews or do not stand in order, or where all of them would have more
// than `max_bytes`. The document has passed check_json().
void expand_accessors(const Source& source, nlohmann::json& document, std::vector<tinygltf::Buffer>& buffers,
                      std::size_t max_bytes);

}  // namespace qtrace::gltf
