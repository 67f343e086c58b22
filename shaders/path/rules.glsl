// The rules of learning: what a path's events give the table. After a ray from x in direction w hit y, the value of
// (x, w) moves towards a target that estimates the radiance which arrives at x from w:
//   expected_sarsa  Le(y) + integral of Q(y, wi) f_r cos(theta_i) dwi     Dahm & Keller 2017; Goswami 2020, eq. 18
//   sarsa           Le(y) + f_r cos(theta') / p(w') Q(y, w'), with w' the direction that is drawn at y
//                                                                         Goswami 2020, eq. 12
//   q_learning      Le(y) + reflectance(y) max over bins of Q(y, .)       Goswami 2020, eq. 13
//   monte_carlo     Le(y) + what the rest of the path brings, up to max_bounces: nothing of the table
//   paper_listing   min(|Le(y)|, 1) where y emits, else throughput of the whole path * max over bins of Q(y, .)
//                                                                         Goswami 2020, listing of section 4.3.2
// The first four estimate the incident radiance, but q_learning an upper bound of it; the last one nothing in
// particular. Whatever they find, only the table differs.
// With rl.learns beyond_nee, radiance is what the path itself brings of it: emission with the weight that next event
// estimation leaves, and the direct light found at y.
#include "path/bsdf_sample.glsl"
#include "path/path.glsl"
#include "sampling/direction.glsl"
#include "sampling/path_bits.glsl"
#include "shared/variants.glsl"
#if SAMPLER == SAMPLER_RL && UPDATE_RULE == UPDATE_MONTE_CARLO
#include "path/monte_carlo.glsl"
#elif SAMPLER == SAMPLER_RL
#include "path/td_rules.glsl"
#else

// Without a table of directions there is nothing to record.
const bool BOOTSTRAPS_AT_LAST_HIT = false;

void record_miss(inout Path path, uint bounce, vec3 radiance, float weight) {}
void record_hit(inout Path path, Event e, BsdfSample next, uint bounce, vec3 emitted, float weight, bool scatters,
                EventBits bits) {}
void record_scattering(inout Path path, uint bounce, vec3 direct, BsdfSample next) {}
void record_survival(uint bounce, float survival) {}
void update_after_ray(inout Path path, PreviousAction previous) {}
void update_after_path(inout Path path) {}

#endif
