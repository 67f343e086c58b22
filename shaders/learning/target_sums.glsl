// What a frame's targets of a table entry sum to, and how many they were, out of the words of a TargetSum.
#include "shared/structs.glsl"

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
