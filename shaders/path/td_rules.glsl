// Rules of temporal differences: a ray's target is what it found and, for what lies beyond, what the table holds there.
#include "learning/gather.glsl"
#include "learning/qtable.glsl"
#include "path/bsdf_sample.glsl"
#include "path/path.glsl"
#include "sampling/direction.glsl"
#include "sampling/path_bits.glsl"
#include "sampling/random.glsl"
#include "shared/fetch.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

// Whether the last hit, where the path ends, is looked up in the table, too.
const bool BOOTSTRAPS_AT_LAST_HIT = LEARNS == LEARNS_ALL;

// `weight`: share of met emission that next event estimation leaves to the path.
void record_miss(inout Path path, uint bounce, vec3 radiance, float weight) {
  path.td_target = average(radiance) * (LEARNS == LEARNS_BEYOND_NEE ? weight : 1.0);
}

// What the table holds of the radiance that leaves y.
float bootstrap(Path path, Event e, BsdfSample next, EventBits bits) {
  if (e.cell.index == NO_CELL) return 0.0;
#if UPDATE_RULE == UPDATE_SARSA
  return average(next.weight) * fetch_one(q_values, next.direction.entry);
#else
  vec3 rotation = to_units(bits.more).yzw;
  return next_value(e.surface, e.bsdf, e.wo, e.cell, path.throughput, rotation);
#endif
}

void record_hit(inout Path path, Event e, BsdfSample next, uint bounce, vec3 emitted, float weight, bool scatters,
                EventBits bits) {
  vec3 met = emitted * (LEARNS == LEARNS_BEYOND_NEE ? weight : 1.0);
  bool bootstraps = frame_teaches != 0u && (scatters || BOOTSTRAPS_AT_LAST_HIT);
  float next_state = bootstraps ? bootstrap(path, e, next, bits) : 0.0;
#if UPDATE_RULE == UPDATE_PAPER_LISTING
  path.td_target = met != vec3(0.0) ? min(length(met), 1.0) : next_state;
#else
  path.td_target = average(met) + next_state;
#endif
}

void record_scattering(inout Path path, uint bounce, vec3 direct, BsdfSample next) {
#if LEARNS == LEARNS_BEYOND_NEE
  path.td_target += average(direct);
#endif
}

void record_survival(uint bounce, float survival) {}

void gather_action(inout Path path, PreviousAction action, float target) {
  gather_radiance(path.tally, action.entry, target);
#ifdef LEARNS_MIXTURE
  gather_square(path.tally, action.share, action.weight * target);
#endif
}

#ifdef HAS_OWN_LOBES

// An event's own lobes (own_lobes.glsl) bring radiance that its cell's table does not hold: where the path goes on by one of
// them, the target of the action that led to the event waits for what the next ray finds, as the path's own estimate of it.
void update_after_ray(inout Path path, PreviousAction previous) {
  float target = path.td_target;
#ifdef HAS_ABSORPTION
  target *= average(path.reaching);
#endif
  PreviousAction action = previous;
  if (path.holds) {
    action = path.held;
    target = path.held_target + path.held_factor * target;
  }
  path.holds = path.draws_own;
  path.held = action;
  path.held_target = target;
  path.held_factor = path.own_factor;
  if (!path.holds) gather_action(path, action, target);
}

// A path may end before the ray that a target waits for.
void update_after_path(inout Path path) {
  if (path.holds) gather_action(path, path.held, path.held_target);
}

#else

void update_after_ray(inout Path path, PreviousAction previous) {
  gather_action(path, previous, path.td_target);
}

void update_after_path(inout Path path) {}

#endif
