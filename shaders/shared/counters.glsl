// 64-bit counters of a frame, and places to replay.
#include "shared/structs.glsl"

layout(std430, binding = BINDING_COUNTERS) restrict coherent buffer CounterBuffer { Counters counters; };

// What one path adds to them.
struct Tally {
  uint rays;
  uint segments;
  uint lookups;
  uint fallbacks;
  uint updates;
  uint saturated;
  uint connections;
};

void count(uint counter, uint amount) {
  uint before = atomicAdd(counters.words[2u * counter], amount);
  if (before + amount < before) atomicAdd(counters.words[2u * counter + 1u], 1u);
}

void report_cut(uvec2 pixel) {
  counters.cut_pixel = pixel;
  count(COUNTER_LOOPS_CUT, 1u);
}

void report_non_finite(uvec2 pixel, uint frame) {
  uint place = atomicAdd(counters.words[2u * COUNTER_ALL_NON_FINITE], 1u);
  count(COUNTER_NON_FINITE, 1u);
  if (place < MAX_LOCATIONS) counters.locations[place] = uvec4(pixel, frame, 0u);
}
