// 64-bit counters of a frame, and places to replay.
#include "shared/structs.glsl"

layout(std430, binding = BINDING_STATISTICS) restrict coherent buffer StatisticsBuffer { Statistics statistics; };

// By the bits: a comparison with NaN may be optimised away.
bool is_finite(float x) {
  return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

void count(uint statistic, uint amount) {
  uint before = atomicAdd(statistics.counters[2u * statistic], amount);
  if (before + amount < before) atomicAdd(statistics.counters[2u * statistic + 1u], 1u);
}

void report_cut(uvec2 pixel) {
  statistics.cut_pixel = pixel;
  count(STATISTIC_LOOPS_CUT, 1u);
}

void report_non_finite(uvec2 pixel, uint frame) {
  uint place = atomicAdd(statistics.counters[2u * STATISTIC_ALL_NON_FINITE], 1u);
  count(STATISTIC_NON_FINITE, 1u);
  if (place < MAX_LOCATIONS) statistics.locations[place] = uvec4(pixel, frame, 0u);
}
