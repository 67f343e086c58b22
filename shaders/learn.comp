#version 450 core
// Once per frame, for every cell: applies the targets that the frame gathered, then prepares what trace.comp
// draws from. One invocation per cell.
#include "variants.glsl"
#include "scene.glsl"
#include "bins.glsl"
#include "statistics.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_Q_VALUES) restrict buffer QValueBuffer { float q_values[]; };
layout(std430, binding = BINDING_Q_VISITS) restrict buffer QVisitBuffer { uint q_visits[]; };
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer TargetSumBuffer { TargetSum target_sums[]; };
layout(std430, binding = BINDING_BIN_STARTS) restrict writeonly buffer BinStartBuffer { uint bin_starts[]; };
layout(std430, binding = BINDING_NEXT_VALUES) restrict writeonly buffer NextValueBuffer { float next_values[]; };

// With alpha = 1 / (1 + visits(cell, bin)) (the report, section 4.3.2) a value is the mean of its targets:
// the m targets of a frame, one after the other, end at (visits Q + their sum) / (visits + m), in any order.
void apply_targets(uint entry) {
  uint targets = target_sums[entry].count & ~TARGET_SATURATED;
  if (targets == 0u) return;
  uint high = target_sums[entry].high;
  float low = float(target_sums[entry].low);
  // What a full sum holds beyond the limit depends on the order of threads; the limit does not.
  if ((target_sums[entry].count & TARGET_SATURATED) != 0u) {
    count(STATISTIC_SATURATED, targets);
    high = TARGET_SATURATED;
    low = 0.0;
  }
  float sum = (float(high) * 4294967296.0 + low) * TARGET_UNIT;
  float visits = float(q_visits[entry]);
  float all = visits + float(targets);
  q_values[entry] = q_values[entry] * (visits / all) + sum / all;
  // Above 2^24 visits alpha no longer changes in a float; the counter must not wrap.
  q_visits[entry] = min(q_visits[entry], 0x7fffffffu) + min(targets, 0x7fffffffu);
  target_sums[entry].low = 0u;
  target_sums[entry].high = 0u;
  target_sums[entry].count = 0u;
}

// Bin starts, as words of 32 bits (see bin_probability in qtable.glsl): every bin gets its equal part of the
// floor in whole words, so that none can vanish in rounding; the rest follows the values.
const float FLOOR_RANGE = 4294966784.0;  // 2^32 - 512: float rounding cannot reach 2^32 from here

void prepare_bins(uint first, float total) {
  float floor_share = total > 0.0 && is_finite(total) ? parameters.rl.y : 1.0;
  uint floor_width = uint(floor_share * (FLOOR_RANGE / float(BINS)));
  float rest = FLOOR_RANGE - float(floor_width) * float(BINS);
  float sum = 0.0;
  uint bin = 0u;
  do {
    float fraction = floor_share < 1.0 ? min(sum / total, 1.0) : 0.0;
    bin_starts[first + bin] = bin * floor_width + uint(max(rest, 0.0) * fraction);
    sum += q_values[first + bin];
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
}

void main() {
  uint cell = gl_WorkGroupID.x * 64u + gl_LocalInvocationID.x;
  if (cell >= parameters.path.w) return;
  uint first = cell * uint(BINS);
  float total = 0.0;
  float irradiance = 0.0;
  float best = 0.0;
  uint bin = 0u;
  do {
    apply_targets(first + bin);
    float value = q_values[first + bin];
    total += value;
    // The mean cosine of a bin: cos(theta) is uniform over its row.
    irradiance += value * (float(bin / uint(BINS_PHI)) + 0.5) / float(BINS_THETA) * BIN_SOLID_ANGLE;
    best = max(best, value);
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = bin < uint(BINS);
  prepare_bins(first, total);
#if UPDATE_RULE == UPDATE_Q_LEARNING
  next_values[cell] = best;
#else
  next_values[cell] = irradiance / PI;
#endif
  if (loop_was_cut) report_cut(uvec2(cell, 0u));
}
