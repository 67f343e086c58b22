// What a device cannot do, said before any work starts.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/context.h"
#include "engine/gpu/scene_buffers.h"

namespace qtrace {

// llvmpipe ends every loop of a shader invocation after 65,535 iterations in total, without an error. Throws
// Error where the loops over sites and bins alone would need more than half of that; what remains is for
// traversal, and shaders report a loop that was cut (Film::check_loops).
void check_loop_budget(const gpu::DeviceInfo& device, const RenderSettings& settings,
                       const gpu::SceneFeatures& features);

}  // namespace qtrace
