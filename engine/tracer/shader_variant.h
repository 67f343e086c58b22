// Settings and scene as compile-time choices of the shaders (shaders/variants.glsl).
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/scene_buffers.h"
#include "engine/gpu/shader_source.h"

namespace qtrace {

gpu::Defines shader_defines(const RenderSettings& settings, const gpu::SceneFeatures& features);

}  // namespace qtrace
