// What a device cannot do, said before any work starts.
#pragma once

#include "engine/core/settings.h"
#include "engine/gpu/context.h"
#include "engine/scene/scene.h"

#include <cstdint>

namespace qtrace {

// So many frames may teach the table between two updates before one of its sums could be full, were all paths
// to teach the same entry at every event.
std::uint32_t most_taught_frames(const RenderSettings& settings);

// Throws Error where the device cannot hold the image or the table, or could cut the loops of a path short.
//
// Some drivers (llvmpipe of Mesa 22.3) end every loop of a shader invocation after 65,535 iterations in
// total, without an error; a context tells whether its own does. Refused there is where the loops over sites,
// bins and lights alone would need more than half of that; what remains is for traversal, and shaders report
// a loop that was cut (Film::check_loops).
void check_limits(const gpu::Context& context, const Scene& scene, const RenderSettings& settings);

}  // namespace qtrace
