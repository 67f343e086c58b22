// The types and indices of a scene file's JSON, checked before tinygltf sees it: tinygltf takes the default
// where a property has the wrong type, wraps integers that are too large, and leaves most indices unchecked.
#pragma once

#include "engine/gltf_document/source.h"

#include <nlohmann/json.hpp>

namespace qtrace::gltf {

// Checks the type of every property that the loader reads (rules.h), and that every index points at
// something; a warning where that is in a texture, an image or an animation that nothing uses.
// Turns integers that stand for numbers into floating point, for tinygltf would wrap them.
void check_json(Source& source, nlohmann::json& document);

}  // namespace qtrace::gltf
