#version 450 core
// Once per frame, for every cell that it gathered targets for: applies the targets that the frame gathered, then
// prepares what trace.comp draws from. One invocation per cell.
#include "geometry/scene.glsl"
#include "learning/rates.glsl"
#include "learning/storage.glsl"
#include "learning/table.glsl"
#include "learning/target_sums.glsl"
#include "learning/touched.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if SAMPLER == SAMPLER_RL
#include "learning/bins.glsl"
#include "learning/shrinkage.glsl"
#endif
#ifdef LEARNS_MIXTURE
#include "learning/mixture.glsl"
#endif

layout(local_size_x = 64) in;

// The actions of one kind of one cell, and what happened to all of them.
struct Actions {
  uint first;
  uint count;
  float visits;   // before this frame
  float targets;  // of this frame
};

Actions actions_at(uint first, uint count) {
  Actions actions = Actions(first, count, 0.0, 0.0);
#if LEARNING_RATE == RATE_VISITS_PER_CELL
  uint i = 0u;
  do {
    actions.visits += float(q_visits[first + i]);
    actions.targets += float(targets_of(target_sums[first + i]));
    ++i;
  } while (i < count);
  loop_was_cut = loop_was_cut || i < count;
#endif
  return actions;
}

void apply_targets(uint entry, Actions actions, float unit) {
  TargetSum sum = target_sums[entry];
  uint targets = targets_of(sum);
  if (targets == 0u) return;
  if (is_full(sum)) count(COUNTER_SATURATED, targets);
  float mean = units_of(sum) * unit / float(targets);
  Step step = learning_step(float(q_visits[entry]), float(targets), actions.visits, actions.targets);
  q_values[entry] = q_values[entry] * step.keep + mean * step.gain;
  count_visits(entry, targets);
  target_sums[entry] = TargetSum(0u, 0u, 0u);
}

// Starts of actions, as words of 32 bits (see action_probability in actions.glsl). Every action gets its part of the
// floor in whole words, so that none can vanish in rounding; the rest follows the values.
const float FLOOR_RANGE = 4294966784.0;  // 2^32 - 512: float rounding cannot reach 2^32 from here

#if SAMPLER == SAMPLER_RL

// What is drawn in proportion to: the values, shrunk, times the mean cosine where it is wanted.
float bin_weight(float value, uint bin) {
  return BIN_WEIGHT == BIN_WEIGHT_VALUE_COSINE ? value * bin_cosine(bin) : value;
}

void prepare_bins(uint first, float total) {
  float floor_share = total > 0.0 && is_finite(total) ? parameters.bin_floor : 1.0;
  uint floor_width = uint(floor_share * (FLOOR_RANGE / float(BINS)));
  float rest = FLOOR_RANGE - float(floor_width) * float(BINS);
  float sum = 0.0;
  uint bin = 0u;
  do {
    float fraction = floor_share < 1.0 ? min(sum / total, 1.0) : 0.0;
    action_starts[first + bin] = bin * floor_width + uint(max(rest, 0.0) * fraction);
    sum += bin_weight(shrunk(first, bin), bin);
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
}

void learn_bins(uint cell) {
  uint first = first_bin(cell);
  Actions actions = actions_at(first, uint(BINS));
  float total = 0.0;
  float irradiance = 0.0;
  float best = 0.0;
  uint bin = 0u;
  do {
    apply_targets(first + bin, actions, TARGET_UNIT);
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
  find_block_means(first);
  bin = 0u;
  do {
    float value = shrunk(first, bin);
    total += bin_weight(value, bin);
    irradiance += value * bin_cosine(bin) * BIN_SOLID_ANGLE;
    best = max(best, value);
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
  prepare_bins(first, total);
#if UPDATE_RULE == UPDATE_Q_LEARNING || UPDATE_RULE == UPDATE_PAPER_LISTING
  next_values[cell] = best;
#else
  next_values[cell] = irradiance / PI;
#endif
}

#endif

#if LIGHT_ACTIONS > 0

// The floor goes by power. Each light has a word of its own besides, so that none can vanish in rounding; and widths
// are rounded as floats, by 2^-24 of themselves a few times, hence the slack.
const float FLOOR_SLACK = 1e-6;

void prepare_lights(uint first, float total) {
  float floor_share = total > 0.0 && is_finite(total) ? parameters.light_floor : 1.0;
  float words = FLOOR_RANGE * (1.0 - FLOOR_SLACK) - float(LIGHT_ACTIONS);
  float floor_words = words * floor_share;
  float rest = words - floor_words;
  float sum = 0.0;
  uint floor_start = 0u;
  uint light = 0u;
  do {
    float fraction = floor_share < 1.0 ? min(sum / total, 1.0) : 0.0;
    action_starts[first + light] = floor_start + uint(rest * fraction);
    sum += sqrt(q_values[first + light]);
    floor_start += uint(floor_words * light_choice(light).y) + 1u;
    ++light;
  } while (light < uint(LIGHT_ACTIONS));
  loop_was_cut = loop_was_cut || light < uint(LIGHT_ACTIONS);
}

void learn_lights(uint cell) {
  uint first = first_light(cell);
  Actions actions = actions_at(first, uint(LIGHT_ACTIONS));
  float total = 0.0;
  uint light = 0u;
  do {
    apply_targets(first + light, actions, LIGHT_TARGET_UNIT);
    total += sqrt(q_values[first + light]);
    ++light;
  } while (light < uint(LIGHT_ACTIONS));
  loop_was_cut = loop_was_cut || light < uint(LIGHT_ACTIONS);
  prepare_lights(first, total);
}

#endif

void main() {
  uint place = gl_WorkGroupID.x * LEARN_GROUP + gl_LocalInvocationID.x;
  if (place >= touched_head.count) return;
  uint cell = touched[place];
#if SAMPLER == SAMPLER_RL
  learn_bins(cell);
#endif
#ifdef LEARNS_MIXTURE
  learn_mixture(cell);
#endif
#if LIGHT_ACTIONS > 0
  learn_lights(cell);
#endif
  if (loop_was_cut) report_cut(uvec2(cell, 0u));
}
