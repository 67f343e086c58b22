// The smallest scene that has everything: a floor, perhaps a light above it, and a camera.
#pragma once

#include "tests/system/temp_folder.h"

#include <string>

namespace qtrace::tests {

enum class Light { on, off };

// Writes `name`.gltf and its buffer into the folder.
void write_small_scene(const TempFolder& folder, const std::string& name, Light light = Light::on);

// A config of 8x8 pixels and 4 frames for scene.gltf, with `extra` members ("\"key\": value, ") in front.
std::string small_config(const std::string& name, const std::string& extra = "");

}  // namespace qtrace::tests
