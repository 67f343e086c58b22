#version 450 core
// Once per frame, for every cell that it taught something: applies the targets that the frame gathered, then
// prepares what trace.comp draws from. One invocation per cell.
#include "variants.glsl"
#include "scene.glsl"
#include "table.glsl"
#include "rates.glsl"
#include "touched.glsl"
#include "statistics.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_Q_VALUES) restrict buffer QValueBuffer { float q_values[]; };
layout(std430, binding = BINDING_Q_VISITS) restrict buffer QVisitBuffer { uint q_visits[]; };
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer TargetSumBuffer { TargetSum target_sums[]; };
layout(std430, binding = BINDING_COLUMN_STARTS) restrict writeonly buffer ColumnStartBuffer { uint column_starts[]; };
layout(std430, binding = BINDING_BSDF_SHARES) restrict writeonly buffer BsdfShareBuffer { float bsdf_shares[]; };
layout(std430, binding = BINDING_NEXT_VALUES) restrict writeonly buffer NextValueBuffer { float next_values[]; };

// Targets that ran over in the counts of the low word, and of the middle one.
uint beyond_low(TargetSum sum) {
  return (sum.middle & SUM_MIDDLE_COUNT) + ((sum.high & SUM_HIGH_COUNT) << SUM_MIDDLE_COUNT_BITS);
}

uint beyond_middle(TargetSum sum) {
  return sum.high & SUM_HIGH_COUNT;
}

uint targets_of(TargetSum sum) {
  return (sum.low & SUM_LOW_COUNT) + (beyond_low(sum) << SUM_LOW_COUNT_BITS);
}

bool is_full(TargetSum sum) {
  return sum.high >> SUM_HIGH_COUNT_BITS >= SUM_HIGH_FULL;
}

// What a full sum holds beyond the limit depends on the order of threads; the limit does not.
float units_of(TargetSum sum) {
  if (is_full(sum)) return float(SUM_HIGH_FULL) * SUM_HIGH_UNIT;
  // As one integer of 64 bits, which is rounded once for each half.
  const uint middle_shift = 32u - SUM_LOW_COUNT_BITS;
  const uint high_shift = middle_shift + 32u - SUM_MIDDLE_COUNT_BITS;
  uint low = sum.low >> SUM_LOW_COUNT_BITS;
  uint middle = (sum.middle >> SUM_MIDDLE_COUNT_BITS) - beyond_middle(sum);
  uint high = sum.high >> SUM_HIGH_COUNT_BITS;
  uint carry, borrow;
  uint low_half = usubBorrow(uaddCarry(middle << middle_shift, low, carry), beyond_low(sum), borrow);
  uint high_half = (high << (high_shift - 32u)) + uint(int(middle) >> (32u - middle_shift)) + carry - borrow;
  return float(high_half) * 4294967296.0 + float(low_half);
}

// The columns of one kind in one row, and what happened to all of them.
struct Columns {
  uint first;
  uint count;
  float visits;   // before this frame
  float targets;  // of this frame
};

Columns columns_at(uint first, uint count) {
  Columns columns = Columns(first, count, 0.0, 0.0);
#if LEARNING_RATE == RATE_VISITS_PER_CELL
  uint i = 0u;
  do {
    columns.visits += float(q_visits[first + i]);
    columns.targets += float(targets_of(target_sums[first + i]));
    ++i;
  } while (i < count);
  loop_was_cut = loop_was_cut || i < count;
#endif
  return columns;
}

void apply_targets(uint entry, Columns columns, float unit) {
  TargetSum sum = target_sums[entry];
  uint targets = targets_of(sum);
  if (targets == 0u) return;
  if (is_full(sum)) count(STATISTIC_SATURATED, targets);
  float mean = units_of(sum) * unit / float(targets);
  Step step = learning_step(float(q_visits[entry]), float(targets), columns.visits, columns.targets);
  q_values[entry] = q_values[entry] * step.keep + mean * step.gain;
  // Above 2^24 visits alpha no longer changes in a float; the counter must not wrap.
  q_visits[entry] = min(q_visits[entry], 0x7fffffffu) + min(targets, 0x7fffffffu);
  target_sums[entry] = TargetSum(0u, 0u, 0u);
}

// Column starts, as words of 32 bits (see column_probability in columns.glsl). Every column gets its part of the
// floor in whole words, so that none can vanish in rounding; the rest follows the values.
const float FLOOR_RANGE = 4294966784.0;  // 2^32 - 512: float rounding cannot reach 2^32 from here

#if SAMPLER == SAMPLER_RL

// What is drawn in proportion to: the values, shrunk, times the mean cosine where it is wanted.
float bin_weight(float value, uint bin) {
  return BIN_WEIGHT == BIN_WEIGHT_VALUE_COSINE ? value * bin_cosine(bin) : value;
}

#ifdef SHRINKS

// Blocks of bins, a quarter of the square's side wide and high.
const uint BLOCKS = 16u;

uint block_of(uint bin) {
  uvec2 place = uvec2(bin / uint(BINS_PHI), bin % uint(BINS_PHI)) * 4u / uvec2(BINS_THETA, BINS_PHI);
  return place.x * 4u + place.y;
}

// Empirical Bayes (Efron & Morris 1973): a bin with few visits is pulled towards the mean of its block, and a block
// towards the mean of its cell. Means over bins count each by how far it stands on its own, so that a bin that is
// visited often because it is bright does not stand for its neighbours.
float block_means[BLOCKS];

void find_block_means(uint first) {
  float sums[BLOCKS], weights[BLOCKS], visits[BLOCKS];
  uint i = 0u;
  do {
    sums[i] = weights[i] = visits[i] = 0.0;
    ++i;
  } while (i < BLOCKS);
  i = 0u;
  do {
    float n = float(q_visits[first + i]);
    float weight = n / (n + parameters.shaping.x);
    uint block = block_of(i);
    sums[block] += weight * q_values[first + i];
    weights[block] += weight;
    visits[block] += n;
    ++i;
  } while (i < uint(BINS));
  float sum = 0.0;
  float weight = 0.0;
  i = 0u;
  do {
    sum += sums[i];
    weight += weights[i];
    ++i;
  } while (i < BLOCKS);
  float mean = weight > 0.0 ? sum / weight : 0.0;
  i = 0u;
  do {
    float own = weights[i] > 0.0 ? sums[i] / weights[i] : 0.0;
    block_means[i] = mix(mean, own, visits[i] / (visits[i] + parameters.shaping.x));
    ++i;
  } while (i < BLOCKS);
}

float shrunk(uint first, uint bin) {
  float n = float(q_visits[first + bin]);
  return mix(block_means[block_of(bin)], q_values[first + bin], n / (n + parameters.shaping.x));
}

#else

void find_block_means(uint first) {}

float shrunk(uint first, uint bin) {
  return q_values[first + bin];
}

#endif

void prepare_bins(uint first, float total) {
  float floor_share = total > 0.0 && is_finite(total) ? parameters.rl.y : 1.0;
  uint floor_width = uint(floor_share * (FLOOR_RANGE / float(BINS)));
  float rest = FLOOR_RANGE - float(floor_width) * float(BINS);
  float sum = 0.0;
  uint bin = 0u;
  do {
    float fraction = floor_share < 1.0 ? min(sum / total, 1.0) : 0.0;
    column_starts[first + bin] = bin * floor_width + uint(max(rest, 0.0) * fraction);
    sum += bin_weight(shrunk(first, bin), bin);
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
}

void learn_bins(uint cell) {
  uint first = first_bin(cell);
  Columns columns = columns_at(first, uint(BINS));
  float total = 0.0;
  float irradiance = 0.0;
  float best = 0.0;
  uint bin = 0u;
  do {
    apply_targets(first + bin, columns, TARGET_UNIT);
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

#ifdef LEARNS_MIXTURE

// Share of the BSDF. If A and B are the sums of the squares of what directions of the BSDF and of the table brought,
// A / (A + B) is a step of expectation maximisation towards the mixture with the least second moment: at a minimum, the
// derivative of the second moment, the integral of (f / p)^2 (p_bsdf - p_table), is zero, and then A / (A + B) is the share
// itself. Later frames count for more, in proportion to their number, since the table that they used was better.
const float LEAST_SHARE = 0.1;
const float PRIOR_VISITS = 32.0;  // that count for bsdf_fraction

void learn_mixture(uint cell) {
  uint first = first_share(cell);
  TargetSum by_bsdf = target_sums[first + SHARE_BSDF];
  TargetSum by_table = target_sums[first + SHARE_TABLE];
  float targets = float(targets_of(by_bsdf)) + float(targets_of(by_table));
  float visits = float(q_visits[first + SHARE_BSDF]) + float(q_visits[first + SHARE_TABLE]);
  if (targets > 0.0) {
    float gain = min(2.0 * targets / (visits + 2.0 * targets), 1.0);
    float scale = LIGHT_TARGET_UNIT / targets;
    q_values[first + SHARE_BSDF] = mix(q_values[first + SHARE_BSDF], units_of(by_bsdf) * scale, gain);
    q_values[first + SHARE_TABLE] = mix(q_values[first + SHARE_TABLE], units_of(by_table) * scale, gain);
    q_visits[first + SHARE_BSDF] += targets_of(by_bsdf);
    q_visits[first + SHARE_TABLE] += targets_of(by_table);
    target_sums[first + SHARE_BSDF] = TargetSum(0u, 0u, 0u);
    target_sums[first + SHARE_TABLE] = TargetSum(0u, 0u, 0u);
    visits += targets;
  }
  float a = q_values[first + SHARE_BSDF];
  float b = q_values[first + SHARE_TABLE];
  float share = a + b > 0.0 ? a / (a + b) : parameters.rl.x;
  share = (share * visits + parameters.rl.x * PRIOR_VISITS) / (visits + PRIOR_VISITS);
  bsdf_shares[cell] = clamp(share, LEAST_SHARE, 1.0 - LEAST_SHARE);
}

#endif

#if LIGHT_COLUMNS > 0

// The floor goes by power. Each light has a word of its own besides, so that none can vanish in rounding; and widths
// are rounded as floats, by 2^-24 of themselves a few times, hence the slack.
const float FLOOR_SLACK = 1e-6;

void prepare_lights(uint first, float total) {
  float floor_share = total > 0.0 && is_finite(total) ? parameters.rl.w : 1.0;
  float words = FLOOR_RANGE * (1.0 - FLOOR_SLACK) - float(LIGHT_COLUMNS);
  float floor_words = words * floor_share;
  float rest = words - floor_words;
  float sum = 0.0;
  uint floor_start = 0u;
  uint light = 0u;
  do {
    float fraction = floor_share < 1.0 ? min(sum / total, 1.0) : 0.0;
    column_starts[first + light] = floor_start + uint(rest * fraction);
    sum += sqrt(q_values[first + light]);
    floor_start += uint(floor_words * light_choice(light).y) + 1u;
    ++light;
  } while (light < uint(LIGHT_COLUMNS));
  loop_was_cut = loop_was_cut || light < uint(LIGHT_COLUMNS);
}

void learn_lights(uint cell) {
  uint first = first_light(cell);
  Columns columns = columns_at(first, uint(LIGHT_COLUMNS));
  float total = 0.0;
  uint light = 0u;
  do {
    apply_targets(first + light, columns, LIGHT_TARGET_UNIT);
    total += sqrt(q_values[first + light]);
    ++light;
  } while (light < uint(LIGHT_COLUMNS));
  loop_was_cut = loop_was_cut || light < uint(LIGHT_COLUMNS);
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
#if LIGHT_COLUMNS > 0
  learn_lights(cell);
#endif
  if (loop_was_cut) report_cut(uvec2(cell, 0u));
}
