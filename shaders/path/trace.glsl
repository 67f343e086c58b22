// A path from its first ray on: at most max_bounces scattering events. Its radiance is what arrives at the ray's
// origin, the emission that the first ray meets included.
#include "geometry/surface.glsl"
#include "light/medium.glsl"
#include "light/nee.glsl"
#include "light/sky.glsl"
#include "material/bsdf.glsl"
#include "material/emission.glsl"
#include "path/bsdf_sample.glsl"
#include "path/path.glsl"
#include "path/roulette.glsl"
#include "path/rules.glsl"
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "sampling/meeting.glsl"
#include "sampling/path_bits.glsl"
#include "sampling/random.glsl"
#include "sampling/state.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#ifdef HAS_LIGHT_PATHS
#include "connection/connection.glsl"
#include "geometry/camera.glsl"
#include "mis/path_sums.glsl"
#include "mis/seen_from.glsl"
#endif

#ifdef HAS_LIGHT_PATHS

// At the first event, which light paths connect to the camera.
PathSums sums_at_first(Event e) {
  CameraView view = camera_view(e.surface.position);
  return PathSums(0.0, float(parameters.light_paths) / (view.density * face_cosine(e, e.wo)));
}

// Behind an event.
PathSums sums_after(Event e, BsdfSample next) {
  vec3 wi = next.direction.direction;
#ifdef HAS_OWN_LOBES
  if (next.direction.is_delta) {
    if (e.sums.chain <= 0.0) return PathSums(0.0, 0.0);
    Event seen = seen_from(e, wi);
    float probability = smooth_lobes(e.surface, e.bsdf, e.wo, wi).probability;
    float reverse = smooth_lobes(seen.surface, seen.bsdf, wi, e.wo).probability;
    return sums_behind_smooth(e, wi, probability, reverse);
  }
#endif
  return sums_behind(e, wi, next.direction.pdf, drawn_by_light_paths(e, wi));
}

#endif

void leave_scene(inout Path path, uint bounce) {
  vec3 radiance = environment_radiance(path.direction);
  float weight = 0.0;
#ifdef HAS_ENVIRONMENT
  weight = bounce == 0u ? 1.0 : environment_weight(path.direction, path.pdf, path.cell, chain_of(path));
  path.radiance += path.throughput * radiance * weight;
#endif
  record_miss(path, bounce, radiance, weight);
}

// Emission at the hit, and what the ray that led here is worth.
void arrive(inout Path path, Event e, BsdfSample next, float t, uint bounce, bool scatters, EventBits bits) {
  vec3 emitted = emitted_radiance(e.surface, e.bsdf);
  float weight =
      bounce == 0u ? 1.0 : emission_weight(e.surface, t, path.direction, path.pdf, path.cell, chain_of(path));
  path.radiance += path.throughput * emitted * weight;
  record_hit(path, e, next, bounce, emitted, weight, scatters, bits);
}

// One scattering event. Returns whether the path goes on.
bool scatter(inout Path path, Event e, BsdfSample next, uint bounce, EventBits bits, RandomKey key) {
  vec3 direct = direct_light(e, bits, path.tally);
  path.radiance += path.throughput * direct;
#ifdef HAS_CONNECTIONS
  path.radiance += path.throughput * connected_light(e, bounce + 1u, key, path.tally);
#endif
  record_scattering(path, bounce, direct, next);
  if (next.weight == vec3(0.0)) return false;
  float by_value = survival_by_value(path, e, next, bounce);
  path.throughput *= next.weight;
  path.roulette *= next.roulette;
  path.origin = ray_origin(e.surface, next.direction.direction);
  path.direction = next.direction.direction;
  path.pdf = next.direction.pdf;
  path.entry = next.direction.entry;
  path.share = next.direction.share;
  path.weight = average(next.weight);
  path.cell = cell_of(e);
#ifdef HAS_LIGHT_PATHS
  path.sums = sums_after(e, next);
#endif
#ifdef HAS_CONNECTIONS
  path.left = e.surface.position;
#endif
#ifdef HAS_OWN_LOBES
  path.draws_own = next.direction.is_own;
  path.own_factor = average(next.direction.weight);
#endif
#ifdef HAS_ABSORPTION
  path.medium = medium_towards(e, path.direction);
#endif
  if (bounce + 1u > parameters.russian_roulette_start) {
    float survival = by_value > 0.0 ? by_value : survival_by_reflectance(path);
    if (to_unit(bits.light.w) >= survival) {
#ifdef HAS_OWN_LOBES
      path.draws_own = false;
#endif
      return false;
    }
    path.throughput /= survival;
    path.roulette /= survival;
#ifdef HAS_OWN_LOBES
    path.own_factor /= survival;
#endif
    record_survival(bounce, survival);
  }
  return true;
}

Event event_at(inout Path path, Meeting met, uint bounce) {
  Event e;
  e.surface = met_surface(met, path.direction);
  e.bsdf = bsdf_of(e.surface, -path.direction);
  e.wo = -path.direction;
#ifdef HAS_ABSORPTION
  e.medium = path.medium;
#endif
#ifdef HAS_LIGHT_PATHS
  e.hit = met.hit;
  e.sums = bounce == 0u ? sums_at_first(e) : path.sums;
#endif
#ifdef HAS_CONNECTIONS
  if (bounce > 0u) e.sums = sums_on_arrival(path.sums, e, path.left);
#endif
  return e;
}

// For directions, for the target of the last of these, or for lights.
bool needs_cell(uint bounce) {
  return LIGHT_ACTIONS > 0 || bounce < parameters.guided_bounces ||
         (frame_teaches != 0u && bounce == parameters.guided_bounces);
}

Path trace(RandomKey key, vec3 origin, vec3 direction) {
  Path path;
  path.origin = origin;
  path.direction = direction;
  path.throughput = vec3(1.0);
  path.roulette = vec3(1.0);
  path.expected = 0.0;
  path.radiance = vec3(0.0);
  path.pdf = 0.0;
  path.cell = NO_CELL;
  path.entry = NO_ENTRY;
  path.share = NO_ENTRY;
  path.weight = 0.0;
  path.td_target = -1.0;
#ifdef HAS_OWN_LOBES
  path.draws_own = false;
  path.own_factor = 0.0;
  path.holds = false;
#endif
#ifdef HAS_ABSORPTION
  path.medium = vec3(0.0);
  path.reaching = vec3(1.0);
#endif
#ifdef HAS_LIGHT_PATHS
  path.sums = PathSums(0.0, 0.0);
#endif
#ifdef HAS_CONNECTIONS
  path.left = origin;
#endif
  path.tally = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u);

  // With two_ray, the last event's light needs no further ray of the path.
  uint last_ray = parameters.max_bounces - (NEE == NEE_TWO_RAY && parameters.max_bounces > 0u ? 1u : 0u);
  PathBits numbers = path_bits(key);
  uint bounce = 0u;
  bool going_on = true;
  do {
    if (going_on) {
      ++path.tally.rays;
      ++path.tally.segments;
      PreviousAction previous = PreviousAction(path.entry, path.share, path.weight);
      Meeting met = meet(path.origin, path.direction, passing_word(key, bounce));
      path.tally.rays += met.passed;
#ifdef HAS_OWN_LOBES
      path.draws_own = false;
#endif
#ifdef HAS_ABSORPTION
      path.reaching = left_after(path.medium, met.hit.t);
      path.throughput *= path.reaching;
#endif
      if (met.hit.triangle == NO_TRIANGLE) {
        leave_scene(path, bounce);
        going_on = false;
      } else {
        Event e = event_at(path, met, bounce);
        EventBits bits = event_bits(numbers, key, bounce);
        bool scatters = bounce < parameters.max_bounces;
        BsdfSample next;
        if (scatters || BOOTSTRAPS_AT_LAST_HIT) {
          find_state(e, path.tally, needs_cell(bounce), bounce < parameters.guided_bounces);
          next = bsdf_sample_at(e, bits.direction);
        }
        arrive(path, e, next, met.hit.t, bounce, scatters, bits);
        going_on = scatters && scatter(path, e, next, bounce, bits, key) && bounce < last_ray;
      }
      update_after_ray(path, previous);
      ++bounce;
    }
  } while (going_on);
  loop_was_cut = loop_was_cut || going_on;
  update_after_path(path);
  // A throughput that broke without meeting light would pass unnoticed.
  if (!is_finite(average(path.throughput))) path.radiance = path.throughput;
  return path;
}
