#pragma once

#include "engine/core/settings.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"
#include "engine/tracer/cell_buffers.h"

namespace qtrace {

// The constants of a run as its shaders read them. `cells`: null without a table.
gpu::Parameters make_parameters(const Camera& camera, const RenderSettings& settings,
                                const gpu::SceneFeatures& features, const CellBuffers* cells);

}  // namespace qtrace
