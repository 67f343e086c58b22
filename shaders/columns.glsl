// Drawing a column of a row in proportion to what was learned, and gathering targets for it. The distributions
// are written by learn.comp alone, between frames.
#include "table.glsl"
#include "touched.glsl"

layout(std430, binding = BINDING_COLUMN_STARTS) restrict readonly buffer ColumnStartBuffer { uint column_starts[]; };
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer TargetSumBuffer { TargetSum target_sums[]; };

// Of the columns [first, first + count) of one row, column c holds the random words from column_starts[first + c]
// up to the next column's start; the last one ends at 2^32. Its probability is therefore exact, also after
// rounding.
float column_probability(uint first, uint count, uint column) {
  uint end = column + 1u < count ? column_starts[first + column + 1u] : 0u;
  uint width = end - column_starts[first + column];
  return width == 0u ? 1.0 : float(width) * (1.0 / 4294967296.0);
}

uint choose_column(uint first, uint count, uint word) {
  uint low = 0u;
  uint high = count;  // the answer lies in [low, high)
  bool searching = true;
  do {
    if (searching) {
      uint middle = (low + high) >> 1u;
      bool right = column_starts[first + middle] <= word;
      low = right ? middle : low;
      high = right ? high : middle;
      searching = high - low > 1u;
    }
  } while (searching);
  loop_was_cut = loop_was_cut || high - low > 1u;
  return low;
}

// Adds a target, in its column's units, to this frame's sum. Integer sums do not depend on the order of threads.
// Returns whether the target was clamped.
bool gather_units(uint entry, float target) {
  touch(entry / TABLE_COLUMNS, entry % TABLE_COLUMNS);
  float units = round(min(target, TARGET_LIMIT));
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

// A radiance, for a direction's column.
bool gather_target(uint entry, float target) {
  return gather_units(entry, target / TARGET_UNIT);
}

// A squared contribution, for a light's column.
bool gather_light_target(uint entry, float target) {
  return gather_units(entry, target / LIGHT_TARGET_UNIT);
}
