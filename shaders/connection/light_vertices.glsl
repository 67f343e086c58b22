// The events of a frame's light paths, which the camera's paths connect to: as many places for each path as it may have events
// before its last one.
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#ifdef HAS_CONNECTIONS

layout(std430, binding = BINDING_LIGHT_VERTICES) restrict buffer LightVertexBuffer { LightVertex light_vertices[]; };

uint vertex_place(uint path, uint kept) {
  return path * (parameters.max_bounces - 1u) + kept;
}

#endif
