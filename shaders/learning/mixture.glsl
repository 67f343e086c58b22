// Share of the BSDF. If A and B are the sums of the squares of what directions of the BSDF and of the table brought,
// A / (A + B) is a step of expectation maximisation towards the mixture with the least second moment: at a minimum, the
// derivative of the second moment, the integral of (f / p)^2 (p_bsdf - p_table), is zero, and then A / (A + B) is the share
// itself. Later frames count for more, in proportion to their number, since the table that they used was better.
#include "learning/storage.glsl"
#include "learning/table.glsl"
#include "learning/target_sums.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

// Of either side. It bounds the weight of a direction that the table, or the BSDF, would not have drawn.
const float LEAST_SHARE = 0.3;
const float PRIOR_VISITS = 32.0;  // that bsdf_fraction counts for

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
    count_visits(first + SHARE_BSDF, targets_of(by_bsdf));
    count_visits(first + SHARE_TABLE, targets_of(by_table));
    target_sums[first + SHARE_BSDF] = TargetSum(0u, 0u, 0u);
    target_sums[first + SHARE_TABLE] = TargetSum(0u, 0u, 0u);
    visits += targets;
  }
  float a = q_values[first + SHARE_BSDF];
  float b = q_values[first + SHARE_TABLE];
  float share = a + b > 0.0 ? a / (a + b) : parameters.bsdf_fraction;
  share = (share * visits + parameters.bsdf_fraction * PRIOR_VISITS) / (visits + PRIOR_VISITS);
  bsdf_shares[cell] = clamp(share, LEAST_SHARE, 1.0 - LEAST_SHARE);
}
