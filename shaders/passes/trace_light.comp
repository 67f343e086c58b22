#version 450 core
// A frame's paths from the lights, and what they bring to the image's pixels.
#include "light_path/light_path.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/work_groups.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_LIGHT_PATHS) restrict writeonly buffer LightPathBuffer { uvec4 light_path_counts[]; };

void main() {
  uint index = dealt_group() * TRACE_GROUP + gl_LocalInvocationID.x;
  if (index >= parameters.light_paths) return;
  LightPath path = trace_light_path(RandomKey(index, frame_number, parameters.seed));
  uint kept = 0u;
#ifdef HAS_CONNECTIONS
  kept = path.kept;
#endif
  light_path_counts[index] = uvec4(path.tally.rays, path.splats | (kept << 16u),
                                   path.tally.lookups | (path.tally.fallbacks << 16u), path.tally.saturated);
  if (loop_was_cut) report_cut(uvec2(index % parameters.image_size.x, index / parameters.image_size.x));
}
