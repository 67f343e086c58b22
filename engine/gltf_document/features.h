// What a file may ask for and this loader does not have: an Error where the file cannot be read without
// it, a warning where it can.
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

namespace qtrace::gltf {

void check_features(Source& source, const nlohmann::json& document);

}  // namespace qtrace::gltf
