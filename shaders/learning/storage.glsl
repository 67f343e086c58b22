// The table's buffers as its update reads and writes them.
#include "shared/structs.glsl"

layout(std430, binding = BINDING_Q_VALUES) restrict buffer QValueBuffer { float q_values[]; };
layout(std430, binding = BINDING_Q_VISITS) restrict buffer QVisitBuffer { uint q_visits[]; };
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer TargetSumBuffer { TargetSum target_sums[]; };
layout(std430, binding = BINDING_ACTION_STARTS) restrict writeonly buffer ActionStartBuffer { uint action_starts[]; };
layout(std430, binding = BINDING_BSDF_SHARES) restrict writeonly buffer BsdfShareBuffer { float bsdf_shares[]; };
layout(std430, binding = BINDING_NEXT_VALUES) restrict writeonly buffer NextValueBuffer { float next_values[]; };

// Above 2^24 visits alpha no longer changes in a float; the counter must not wrap.
void count_visits(uint entry, uint targets) {
  q_visits[entry] = min(q_visits[entry], 0x7fffffffu) + min(targets, 0x7fffffffu);
}
