#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/scene_buffers.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

namespace qtrace {

// The constants of a run as its shaders read them.
gpu::Parameters make_parameters(const Camera& camera, const RenderSettings& settings,
                                const gpu::SceneFeatures& features, gpu::uint cells);

}  // namespace qtrace
