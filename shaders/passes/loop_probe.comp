#version 450 core
// How many turns of nested loops are done of those that are asked for (engine/gpu/driver_probe.h).
#include "shared/structs.glsl"

layout(local_size_x = 1) in;
layout(std430, binding = BINDING_OUTPUT) restrict buffer TurnBuffer {
  uint outer_turns;
  uint inner_turns;
  uint done;
  uint state;  // depends on every turn, so that none is left out
};

void main() {
  uint turns = 0u;
  uint x = state;
  for (uint i = 0u; i < outer_turns; ++i) {
    for (uint j = 0u; j < inner_turns; ++j) {
      x = (x ^ (x >> 15)) * 1664525u + j;
      ++turns;
    }
    ++turns;
  }
  done = turns;
  state = x;
}
