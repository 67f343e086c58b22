// The JSON of a scene file.
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace qtrace::gltf {

// Throws Error for what is no JSON, nests too deep, or is no glTF 2.
nlohmann::json parse_json(const Source& source, const std::string& text);

// Null where `object` is none, or has no such member.
const nlohmann::json& member(const nlohmann::json& object, std::string_view name);

}  // namespace qtrace::gltf
