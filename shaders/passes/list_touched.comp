#version 450 core
// Lists the cells that the frame has marked, and forgets the marks. One invocation per cell.
#include "learning/table.glsl"
#include "learning/touched.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer SumWordBuffer { uint sum_words[]; };

void main() {
  uint cell = gl_WorkGroupID.x * LEARN_GROUP + gl_LocalInvocationID.x;
  if (cell >= parameters.cells || sum_words[mark_of(cell)] == 0u) return;
  sum_words[mark_of(cell)] = 0u;
  uint place = atomicAdd(touched_head.count, 1u);
  touched[place] = cell;
  if (place % LEARN_GROUP == 0u) atomicAdd(touched_head.groups_x, 1u);
}
