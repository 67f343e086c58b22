// Settings and scene as compile-time choices of the shaders (shaders/shared/variants.glsl).
#pragma once

#include "engine/core/settings.h"
#include "engine/device_scene/scene_buffers.h"
#include "engine/gpu/shader_source.h"
#include "engine/tracer/cell_buffers.h"

namespace qtrace {

// The settings as they take effect: without lights there is nothing to sample, and the path's own rays count
// all there is.
RenderSettings effective_settings(RenderSettings settings, const gpu::SceneFeatures& features);

// Actions of a table's state: direction bins, lights whose use is learned, and sides of a learned mixture. Of
// effective settings.
std::size_t table_actions(const RenderSettings& settings, const gpu::SceneFeatures& features);

gpu::Defines shader_defines(const RenderSettings& settings, const gpu::SceneFeatures& features);

// And of what these cells allow the tracing shader to leave out.
gpu::Defines with_cells(gpu::Defines defines, const CellBuffers& cells);

}  // namespace qtrace
