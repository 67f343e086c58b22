// The Q-table as the tracer uses it: drawing bins, and gathering targets. Entry = cell * BINS + bin holds the
// expected incident radiance, averaged over the channels. Written by learn.comp alone, between frames.
#include "bsdf.glsl"
#include "bins.glsl"
#include "cells.glsl"

layout(std430, binding = BINDING_Q_VALUES) restrict readonly buffer QValueBuffer { float q_values[]; };
layout(std430, binding = BINDING_BIN_STARTS) restrict readonly buffer BinStartBuffer { uint bin_starts[]; };
layout(std430, binding = BINDING_NEXT_VALUES) restrict readonly buffer NextValueBuffer { float next_values[]; };
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer TargetSumBuffer { TargetSum target_sums[]; };

// Bin b of a cell holds the random words from bin_starts[b] up to the next bin's start; the last one ends at
// 2^32. Its probability is therefore exact, also after rounding.
float bin_probability(uint cell, uint bin) {
  uint entry = cell * uint(BINS) + bin;
  uint end = bin + 1u < uint(BINS) ? bin_starts[entry + 1u] : 0u;
  uint width = end - bin_starts[entry];
  return width == 0u ? 1.0 : float(width) * (1.0 / 4294967296.0);
}

uint choose_bin(uint cell, uint word) {
  uint first = cell * uint(BINS);
  uint low = 0u;
  uint high = uint(BINS);  // the answer lies in [low, high)
  bool searching = true;
  do {
    if (searching) {
      uint middle = (low + high) >> 1u;
      bool right = bin_starts[first + middle] <= word;
      low = right ? middle : low;
      high = right ? high : middle;
      searching = high - low > 1u;
    }
  } while (searching);
  loop_was_cut = loop_was_cut || high - low > 1u;
  return low;
}

// Density per solid angle of drawing a bin by its value, then a direction uniformly in it.
float table_pdf(uint cell, uint bin) {
  return bin_probability(cell, bin) / BIN_SOLID_ANGLE;
}

// What is reflected towards `wo` of the table's radiance: the second term of a target.
//   expected_sarsa: the integral of Q f_r cos(theta) (Dahm & Keller 2017; the report, eq. 18)
//   q_learning: the best bin's value in its place, discounted by the reflectance (the report, eq. 13)
float next_value(Surface s, Bsdf b, vec3 wo, Cell cell) {
#if defined(HAS_SPECULAR) && UPDATE_RULE == UPDATE_EXPECTED_SARSA
  // Midpoint rule over the bins.
  float sum = 0.0;
  uint bin = 0u;
  do {
    vec3 wi = to_world(direction_in_bin(bin, vec2(0.5)), cell.tangent, s.normal);
    sum += q_values[uint(cell.index) * uint(BINS) + bin] * average(bsdf_cosine(s, b, wo, wi));
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
  return sum * BIN_SOLID_ANGLE;
#else
  // Prepared by learn.comp: the cell's irradiance / pi, or its best value.
  return reflectance(s, b, wo) * next_values[cell.index];
#endif
}

// Adds a target to this frame's sum. Integer sums do not depend on the order of threads.
// Returns whether the target was clamped.
bool gather_target(uint entry, float target) {
  float units = round(min(target, TARGET_LIMIT) / TARGET_UNIT);
  uint high = uint(units * (1.0 / 4294967296.0));
  uint low = uint(units - float(high) * 4294967296.0);
  atomicAdd(target_sums[entry].count, 1u);
  uint before_low = atomicAdd(target_sums[entry].low, low);
  if (before_low + low < before_low) ++high;
  if (high != 0u) {
    // One step is far below TARGET_SATURATED: some add of any order crosses it, and the flag stays.
    uint before_high = atomicAdd(target_sums[entry].high, high);
    if (before_high + high >= TARGET_SATURATED) atomicOr(target_sums[entry].count, TARGET_SATURATED);
  }
  return target > TARGET_LIMIT;
}
