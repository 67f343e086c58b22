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

// A direction drawn at a hit, and what the path's throughput takes from it.
struct Departure {
  DirectionSample direction;
  vec3 weight;  // f_r cos(theta) / pdf; zero where nothing is reflected that way
};

Departure depart(Event e, RandomKey key, uint bounce) {
  Departure next;
  next.direction = sample_direction(e, random_bits(key, bounce * BLOCKS_PER_EVENT + BLOCK_DIRECTION));
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, next.direction.direction);
  next.weight = reflected == vec3(0.0) ? vec3(0.0) : reflected / next.direction.pdf;
  return next;
}

#if SAMPLER == SAMPLER_RL

void learn(inout Tally tally, uint entry, float target) {
  // A target that is not finite belongs to a sample that is reported.
  if (entry != NO_ENTRY && is_finite(target)) {
    ++tally.updates;
    if (gather_target(entry, target)) ++tally.saturated;
  }
}

#endif

#if SAMPLER != SAMPLER_RL

void learn_leaving(inout Path path, uint bounce, vec3 radiance, float weight) {}
void learn_arriving(inout Path path, Event e, Departure next, uint bounce, vec3 emitted, float weight, RandomKey key) {}
void learn_scattering(uint bounce, vec3 direct, Departure next) {}
void learn_survival(uint bounce, float survival) {}
void learn_path(inout Path path) {}

#elif UPDATE_RULE == UPDATE_MONTE_CARLO

#include "monte_carlo.glsl"

#else

void learn_leaving(inout Path path, uint bounce, vec3 radiance, float weight) {
  learn(path.tally, path.entry, average(radiance));
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

void learn_arriving(inout Path path, Event e, Departure next, uint bounce, vec3 emitted, float weight, RandomKey key) {
#if UPDATE_RULE == UPDATE_PAPER_LISTING
  bool emits = emitted != vec3(0.0);
  learn(path.tally, path.entry, emits ? min(length(emitted), 1.0) : promise(path, e, next, bounce, key));
#else
  learn(path.tally, path.entry, average(emitted) + promise(path, e, next, bounce, key));
#endif
}

void learn_scattering(uint bounce, vec3 direct, Departure next) {}
void learn_survival(uint bounce, float survival) {}
void learn_path(inout Path path) {}

#endif
