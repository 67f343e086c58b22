// 64-bit counters of a frame, and places to replay.
#include "structs.glsl"

layout(std430, binding = BINDING_STATISTICS) restrict coherent buffer StatisticsBuffer {
  uvec2 cut_pixel;
  uvec2 unused;
  uvec4 locations[MAX_LOCATIONS];    // of non-finite samples: x, y, frame
  uint statistics[];                 // STATISTIC_COUNT pairs: low and high word
};

// By the bits: a comparison with NaN may be optimised away.
bool is_finite(float x) {
  return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

void count(uint statistic, uint amount) {
  uint before = atomicAdd(statistics[2u * statistic], amount);
  if (before + amount < before) atomicAdd(statistics[2u * statistic + 1u], 1u);
}

void report_cut(uvec2 pixel) {
  cut_pixel = pixel;
  count(STATISTIC_LOOPS_CUT, 1u);
}

void report_non_finite(uvec2 pixel, uint frame) {
  uint place = atomicAdd(statistics[2u * STATISTIC_ALL_NON_FINITE], 1u);
  count(STATISTIC_NON_FINITE, 1u);
  if (place < MAX_LOCATIONS) locations[place] = uvec4(pixel, frame, 0u);
}
