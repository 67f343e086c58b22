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
  uint i = 0u;
  do {
    uint j = 0u;
    do {
      x = (x ^ (x >> 15)) * 1664525u + j;
      ++turns;
    } while (++j < inner_turns);
    ++turns;
  } while (++i < outer_turns);
  done = turns;
  state = x;
}
