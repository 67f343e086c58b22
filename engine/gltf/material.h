#pragma once

#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gltf {

// The file's materials in its order, without their textures (texture.h). Error, with the material's name, for
// factors out of their range.
std::vector<Material> read_materials(Source& source);

}  // namespace qtrace::gltf
