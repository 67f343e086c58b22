#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gltf {

// The file's materials in its order. Warnings name the textures and alpha modes that are not modelled.
std::vector<Material> read_materials(Source& source);

}  // namespace qtrace::gltf
