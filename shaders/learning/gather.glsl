// Targets as paths gather them: in frames that teach the table, and counted. One that is not finite belongs to a sample
// that is reported.
#include "learning/actions.glsl"
#include "shared/counters.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

// For a direction.
void gather_radiance(inout Tally tally, uint entry, float target) {
  if (frame_teaches != 0u && entry != NO_ENTRY && is_finite(target)) {
    ++tally.updates;
    if (gather_target(entry, target)) ++tally.saturated;
  }
}

// For a light or a side of the mixture, the square of its contribution in units of the brightest light.
void gather_square(inout Tally tally, uint entry, float contribution) {
  float part = contribution * parameters.inverse_brightest;
  if (frame_teaches != 0u && entry != NO_ENTRY && is_finite(part)) {
    ++tally.updates;
    if (gather_light_target(entry, part * part)) ++tally.saturated;
  }
}
