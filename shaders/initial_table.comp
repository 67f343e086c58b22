#version 450 core
// The table before anything is learned. One invocation per cell. Lights start at zero, which means by power.
#include "variants.glsl"
#include "scene.glsl"
#include "random.glsl"
#include "table.glsl"
#include "statistics.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_Q_VALUES) restrict writeonly buffer QValueBuffer { float q_values[]; };

// Apart from the random numbers of the paths, whose frames count from 1.
const uint FRAME_OF_TABLE = 0u;

float initial_value(uint cell, uint bin) {
#if INITIAL_TABLE == INITIAL_CONSTANT
  return parameters.learning.z;
#elif INITIAL_TABLE == INITIAL_RANDOM
  return parameters.learning.z * random_units(RandomKey(cell, FRAME_OF_TABLE, parameters.image.z), bin).x;
#elif INITIAL_TABLE == INITIAL_COSINE
  return parameters.learning.z * bin_cosine(bin);
#else
  return 0.0;
#endif
}

void main() {
  uint cell = gl_WorkGroupID.x * LEARN_GROUP + gl_LocalInvocationID.x;
  if (cell >= parameters.path.w) return;
  uint column = 0u;
  do {
    q_values[first_bin(cell) + column] = column < uint(BINS) ? initial_value(cell, column) : 0.0;
    ++column;
  } while (column < TABLE_COLUMNS);
  if (column < TABLE_COLUMNS) report_cut(uvec2(cell, 0u));
}
