// What a path teaches the table, at the moments of its way. After a ray from x in direction w hit y, the value of
// (x, w) moves towards a target that estimates the radiance which arrives at x from w:
//   expected_sarsa  Le(y) + integral of Q(y, wi) f_r cos(theta_i) dwi     Dahm & Keller 2017; the report, eq. 18
//   sarsa           Le(y) + f_r cos(theta') / p(w') Q(y, w'), with w' the direction that is drawn at y
//                                                                         the report, eq. 12
//   q_learning      Le(y) + reflectance(y) max over bins of Q(y, .)       the report, eq. 13
//   monte_carlo     Le(y) + what the rest of the path brings, up to max_bounces: nothing of the table
//   paper_listing   min(|Le(y)|, 1) where y emits, else throughput of the whole path * max over bins of Q(y, .)
//                                                                         the report, listing of section 4.3.2
// The first four estimate the incident radiance, but q_learning an upper bound of it; the last one nothing in
// particular. Whatever they find, only the table differs.
// With rl.learns beyond_nee, radiance is what the path itself brings of it: emission with the weight that next event
// estimation leaves, and the direct light found at y.

// A direction drawn at a hit, and what the path's throughput takes from it.
struct Departure {
  DirectionSample direction;
  vec3 weight;  // f_r cos(theta) / pdf; zero where nothing is reflected that way
  vec3 roulette;  // the factor of what Russian roulette goes by
};

Departure depart(Event e, RandomKey key, uint bounce) {
  Departure next;
  next.direction = sample_direction(e, random_bits(key, bounce * BLOCKS_PER_EVENT + BLOCK_DIRECTION));
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, next.direction.direction);
  next.weight = reflected == vec3(0.0) ? vec3(0.0) : reflected / next.direction.pdf;
  next.roulette = next.weight;
#if SAMPLER == SAMPLER_RL && ROULETTE != ROULETTE_THROUGHPUT
  if (next.direction.bsdf > 0.0) next.roulette = reflected / next.direction.bsdf;
#endif
  return next;
}

#if SAMPLER == SAMPLER_RL

void learn(inout Tally tally, uint entry, float target) {
  // A target that is not finite belongs to a sample that is reported.
  if (frame_teaches != 0u && entry != NO_ENTRY && is_finite(target)) {
    ++tally.updates;
    if (gather_target(entry, target)) ++tally.saturated;
  }
}

// The square of what a direction brought, for the side of the mixture that drew it (mixture.glsl).
void learn_share(inout Tally tally, uint entry, float contribution) {
#ifdef LEARNS_MIXTURE
  float part = contribution * parameters.environment.w;
  if (frame_teaches != 0u && entry != NO_ENTRY && is_finite(part)) {
    ++tally.updates;
    if (gather_light_target(entry, part * part)) ++tally.saturated;
  }
#endif
}

#endif

// Whether a rule learns at the last hit, where the path ends, from what the table holds there.
#if SAMPLER == SAMPLER_RL && UPDATE_RULE != UPDATE_MONTE_CARLO && LEARNS == LEARNS_ALL
const bool ENDS_TEACH = true;
#else
const bool ENDS_TEACH = false;
#endif

#if SAMPLER != SAMPLER_RL

void learn_leaving(inout Path path, uint bounce, vec3 radiance, float weight) {}
void learn_arriving(inout Path path, Event e, Departure next, uint bounce, vec3 emitted, float weight, bool scatters,
                    RandomKey key) {}
void learn_scattering(inout Path path, uint bounce, vec3 direct, Departure next) {}
void learn_survival(uint bounce, float survival) {}
void learn_lesson(inout Path path, Taught taught) {}
void learn_path(inout Path path) {}

#elif UPDATE_RULE == UPDATE_MONTE_CARLO

#include "learning/monte_carlo.glsl"

#else

// `weight`: share of met emission that next event estimation leaves to the path.
void learn_leaving(inout Path path, uint bounce, vec3 radiance, float weight) {
  path.lesson = average(radiance) * (LEARNS == LEARNS_BEYOND_NEE ? weight : 1.0);
}

// The promise of the table at y.
float promise(Path path, Event e, Departure next, uint bounce, RandomKey key) {
  if (e.cell.index == NO_CELL) return 0.0;
#if UPDATE_RULE == UPDATE_SARSA
  return average(next.weight) * fetch_one(q_values, next.direction.entry);
#else
  vec3 rotation = random_units(key, bounce * BLOCKS_PER_EVENT + BLOCK_MORE).yzw;
  return next_value(e.surface, e.bsdf, e.wo, e.cell, path.throughput, rotation);
#endif
}

void learn_arriving(inout Path path, Event e, Departure next, uint bounce, vec3 emitted, float weight, bool scatters,
                    RandomKey key) {
  vec3 met = emitted * (LEARNS == LEARNS_BEYOND_NEE ? weight : 1.0);
  float promised = frame_teaches != 0u && (scatters || ENDS_TEACH) ? promise(path, e, next, bounce, key) : 0.0;
#if UPDATE_RULE == UPDATE_PAPER_LISTING
  path.lesson = met != vec3(0.0) ? min(length(met), 1.0) : promised;
#else
  path.lesson = average(met) + promised;
#endif
}

void learn_scattering(inout Path path, uint bounce, vec3 direct, Departure next) {
#if LEARNS == LEARNS_BEYOND_NEE
  path.lesson += average(direct);
#endif
}

void learn_survival(uint bounce, float survival) {}

void learn_lesson(inout Path path, Taught taught) {
  learn(path.tally, taught.entry, path.lesson);
  learn_share(path.tally, taught.share, taught.weight * path.lesson);
}

void learn_path(inout Path path) {}

#endif
