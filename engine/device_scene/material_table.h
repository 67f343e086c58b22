// Materials as the shaders fetch them: vec4 by vec4, the uses of their textures behind them.
#pragma once

#include "engine/device_scene/texture_table.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <vector>

namespace qtrace::gpu {

std::vector<vec4> pack_materials(const Scene& scene, const TextureTable& textures);

}  // namespace qtrace::gpu
