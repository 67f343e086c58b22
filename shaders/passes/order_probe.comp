#version 450 core
// In which order work groups begin (engine/gpu/driver_probe.h). Each then works for a while.
#include "shared/structs.glsl"

layout(local_size_x = 1) in;
layout(std430, binding = BINDING_OUTPUT) restrict coherent buffer OrderBuffer {
  uvec2 begun;     // x: groups so far
  uvec2 groups[];  // x: place in the order, y: depends on all that was done, so that nothing is left out
};

void main() {
  uint place = atomicAdd(begun.x, 1u);
  uint x = place;
  for (uint i = 0u; i < 2000u; ++i) x = (x ^ (x >> 15)) * 1664525u + i;
  groups[gl_WorkGroupID.x] = uvec2(place, x);
}
