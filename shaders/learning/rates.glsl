// Learning rates: how far the targets of one frame move a value. After m targets with mean M a value Q becomes
// keep * Q + gain * M with keep + gain = 1. Both are given: where one is tiny, the other's difference to 1 has no
// digits left.
#include "shared/parameters.glsl"
#include "shared/variants.glsl"

struct Step {
  float keep;
  float gain;
};

// log(1 + x) and 1 - exp(x), where x may be small against 1: three terms of the series are
// good to 3e-7 of it there.
const float SERIES_LIMIT = 0.01;

float log_one_plus(float x) {
  return abs(x) < SERIES_LIMIT ? x * (1.0 - x * (0.5 - x / 3.0)) : log(1.0 + x);
}

float one_minus_exp(float x) {
  return abs(x) < SERIES_LIMIT ? -x * (1.0 + x * (0.5 + x / 6.0)) : 1.0 - exp(x);
}

// keep = exp(exponent), of which minus infinity is allowed.
Step step_of(float exponent) {
  return exponent < -80.0 ? Step(0.0, 1.0) : Step(exp(exponent), one_minus_exp(exponent));
}

// m targets at a fixed rate, in the mean over their orders: keep = (1 - alpha)^m.
Step fixed_rate(float alpha, float targets) {
  return alpha >= 1.0 ? Step(0.0, 1.0) : step_of(targets * log_one_plus(-alpha));
}

// `visits` of the entry before this frame and `targets` of this frame; the same of all its cell's actions of the kind.
Step learning_step(float visits, float targets, float cell_visits, float cell_targets) {
#if LEARNING_RATE == RATE_VISITS_PER_BIN
  // alpha = 1 / (1 + visits(cell, bin)) (Goswami 2020, section 4.3.2): the mean of all targets, in any order.
  float all = visits + targets;
  return Step(visits / all, targets / all);
#elif LEARNING_RATE == RATE_VISITS_PER_CELL
  // alpha = 1 / (1 + visits(cell)) (the listing of Goswami 2020). If all M targets of the cell were for one value,
  // N / (N + M) of it would be left; m of them, evenly mixed among the others, leave the m/M-th power of that.
  if (cell_visits == 0.0) return Step(0.0, 1.0);
  return step_of(-targets / cell_targets * log_one_plus(cell_targets / cell_visits));
#elif LEARNING_RATE == RATE_CONSTANT
  return fixed_rate(parameters.rate_constant, targets);
#else
  // alpha = (1 + visits)^-exponent, that of the frame's start.
  return fixed_rate(pow(1.0 + visits, -parameters.rate_exponent), targets);
#endif
}
