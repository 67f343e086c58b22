// A path on its way, and what of the table its last ray belongs to.
#include "sampling/event.glsl"
#include "shared/counters.glsl"
#include "shared/variants.glsl"

// The action that drew a ray's direction: what the ray's target is for.
struct PreviousAction {
  uint entry;
  uint share;
  float weight;
};

struct Path {
  vec3 origin;
  vec3 direction;
  vec3 throughput;
  vec3 roulette;  // what Russian roulette goes by
  float expected;  // of the path beyond its first event, by the table
  vec3 radiance;
  float pdf;   // of `direction`, per solid angle
  int cell;    // of the surface that it left, NO_CELL where it has none
  uint entry;  // of the Q-table that chose `direction`
  float td_target;  // for that entry, as far as it is known
  uint share;    // of the Q-table, for the side of the mixture that drew `direction`
  float weight;  // throughput of the event that it left, averaged over the channels
#ifdef HAS_OWN_LOBES
  bool draws_own;    // `direction` was drawn by one of the BSDF's own lobes,
  float own_factor;  // which weighs what comes from there by this, averaged over the channels
  // The target of an action that waits for what the next ray finds (td_rules.glsl).
  bool holds;
  PreviousAction held;
  float held_target;
  float held_factor;
#endif
#ifdef HAS_ABSORPTION
  vec3 medium;    // absorption per length where the ray is
  vec3 reaching;  // part of radiance that the last ray's way leaves
#endif
#ifdef HAS_LIGHT_PATHS
  PathSums sums;
#endif
#ifdef HAS_CONNECTIONS
  vec3 left;  // position of the event that `origin` is at
#endif
  Tally tally;
};

float chain_of(Path path) {
#ifdef HAS_LIGHT_PATHS
  return path.sums.chain;
#else
  return 0.0;
#endif
}
