#version 450 core
// How many turns of a loop are done of those that are asked for (engine/gpu/driver_probe.h).
#include "shared/structs.glsl"

layout(local_size_x = 1) in;
layout(std430, binding = BINDING_OUTPUT) restrict buffer TurnBuffer {
  uint asked;
  uint done;
  uint state;  // depends on every turn, so that none is left out
};

void main() {
  uint turns = 0u;
  uint x = state;
  for (uint i = 0u; i < asked; ++i) {
    x = (x ^ (x >> 15)) * 1664525u + i;
    ++turns;
  }
  done = turns;
  state = x;
}
