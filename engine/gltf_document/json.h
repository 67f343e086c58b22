// The JSON of a scene file.
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <string>

namespace qtrace::gltf {

// Throws Error for what is no JSON, nests too deep, or is no glTF 2.
nlohmann::json parse_json(const Source& source, const std::string& text);

}  // namespace qtrace::gltf
