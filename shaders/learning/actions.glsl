// Drawing an action of a state in proportion to what was learned, and gathering targets for it. The distributions
// are written by learn.comp alone, between frames.
#include "learning/table.glsl"
#include "shared/fetch.glsl"
#include "shared/loops.glsl"
#include "shared/structs.glsl"

FETCHED_UINT(action_starts, UNIT_ACTION_STARTS);
// The sums of all entries, word by word, then the marks of the cells.
layout(std430, binding = BINDING_TARGET_SUMS) restrict buffer SumWordBuffer { uint sum_words[]; };

// Of the actions [first, first + count) of one state, action a holds the random words from action_starts[first + a]
// up to the next action's start; the last one ends at 2^32. Its probability is therefore exact, also after
// rounding.
float width_probability(uint width) {
  return width == 0u ? 1.0 : float(width) * (1.0 / 4294967296.0);
}

float action_probability(uint first, uint count, uint action) {
  uint end = action + 1u < count ? fetch_one(action_starts, first + action + 1u) : 0u;
  return width_probability(end - fetch_one(action_starts, first + action));
}

struct Choice {
  uint action;
  float probability;  // to the bit that of action_probability
};

// As many turns whatever the word: without conditions, and unrolled where the count is a constant.
Choice choose_action(uint first, uint count, uint word) {
  uint low = 0u;
  uint high = count;  // the answer lies in [low, high)
  uint start = 0u;    // of action low, and of action high
  uint end = 0u;
  for (int turns = findMSB(count - 1u); turns >= 0; --turns) {
    uint middle = (low + high) >> 1u;
    uint value = fetch_one(action_starts, first + middle);
    bool right = value <= word;
    low = right ? middle : low;
    start = right ? value : start;
    high = right ? high : middle;
    end = right ? end : value;
  }
  loop_was_cut = loop_was_cut || high - low > 1u;
  return Choice(low, width_probability(end - start));
}

// Adds a target, in its action's units, to this frame's sum (TargetSum in structs.glsl). Integer sums do not depend on
// the order of threads. Returns whether the target was clamped.
// One addition a turn, and seldom more than two turns (shaders/README.md).
bool gather_units(uint entry, float target) {
  float units = round(min(target, TARGET_LIMIT));
  uint high = uint(units * (1.0 / SUM_HIGH_UNIT));
  units -= float(high) * SUM_HIGH_UNIT;
  uint middle = uint(units * (1.0 / SUM_MIDDLE_UNIT));
  uint low = uint(units - float(middle) * SUM_MIDDLE_UNIT);
  uint first_word = entry * SUM_WORDS;
  uint place = first_word + SUM_LOW;
  uint amount = (low << SUM_LOW_COUNT_BITS) | 1u;
  uint step = SUM_LOW;
  uint counted = 0u;  // what the count of the next word gets
  bool is_first = false;
  bool is_full = false;
  bool adding = true;
  do {
    if (adding) {
      uint before = atomicAdd(sum_words[place], amount);
      uint carry = before + amount < before ? 1u : 0u;
      if (step == SUM_LOW) {
        is_first = before == 0u;
        counted = (before & SUM_LOW_COUNT) == SUM_LOW_COUNT ? 1u : 0u;
        middle += carry;
        high += middle >> (32u - SUM_MIDDLE_COUNT_BITS);
      } else if (step == SUM_MIDDLE) {
        counted = (before & SUM_MIDDLE_COUNT) == SUM_MIDDLE_COUNT ? counted : 0u;
        high += carry;
      } else if (step == SUM_HIGH) {
        // Taken back, so that the word cannot overflow: all additions of one frame would, those in flight do not.
        is_full = before >> SUM_HIGH_COUNT_BITS >= SUM_HIGH_FULL;
      }
      ++step;
      uint more = (middle << SUM_MIDDLE_COUNT_BITS) | counted;
      uint most = (high << SUM_HIGH_COUNT_BITS) | counted;
      if (step == SUM_MIDDLE && more == 0u) ++step;
      if (step == SUM_HIGH && most == 0u) ++step;
      if (step == SUM_RETURN && !is_full) ++step;
      if (step == SUM_MARK && !is_first) ++step;
      amount = step == SUM_MIDDLE ? more : step == SUM_HIGH ? most : 1u;
      if (step == SUM_RETURN) amount = 0u - (high << SUM_HIGH_COUNT_BITS);
      place = step == SUM_MARK ? mark_of(entry / TABLE_ACTIONS) : first_word + min(step, SUM_HIGH);
      adding = step <= SUM_MARK;
    }
  } while (adding);
  loop_was_cut = loop_was_cut || adding;
  return target > TARGET_LIMIT;
}

// A radiance, for a direction.
bool gather_target(uint entry, float target) {
  return gather_units(entry, target / TARGET_UNIT);
}

// A squared contribution, for a light or a side of the mixture.
bool gather_light_target(uint entry, float target) {
  return gather_units(entry, target / LIGHT_TARGET_UNIT);
}
