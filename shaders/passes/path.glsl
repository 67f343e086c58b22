// A path from its first ray on: at most max_bounces scattering events. Its radiance is what arrives at the ray's
// origin, the emission that the first ray meets included.
#include "light/nee.glsl"

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
  float lesson;  // for that entry, what its ray has found so far; negative: nothing to learn
  uint share;    // of the Q-table, for the side of the mixture that drew `direction`
  float weight;  // that the ray's finds have for what it left, averaged over the channels
  Tally tally;
};

// Of the table, what a ray teaches.
struct Taught {
  uint entry;
  uint share;
  float weight;
};

#include "learning/learning.glsl"
#include "sampling/roulette.glsl"

void leave_scene(inout Path path, uint bounce) {
  vec3 radiance = parameters.environment.rgb;
  float weight = 0.0;
#ifdef HAS_ENVIRONMENT
  weight = NEE == NEE_TWO_RAY && bounce > 0u ? 0.0 : 1.0;
  path.radiance += path.throughput * radiance * weight;
#endif
  learn_leaving(path, bounce, radiance, weight);
}

// Emission at the hit, and the lesson of the ray that led here.
void arrive(inout Path path, Event e, Departure next, float t, uint bounce, bool scatters, RandomKey key) {
  vec3 emitted = emitted_radiance(e.surface);
  float weight =
      bounce == 0u ? 1.0 : emission_weight(e.surface, t, path.direction, path.pdf, path.cell);
  path.radiance += path.throughput * emitted * weight;
  learn_arriving(path, e, next, bounce, emitted, weight, scatters, key);
}

// One scattering event. Returns whether the path goes on.
bool scatter(inout Path path, Event e, Departure next, uint bounce, RandomKey key) {
  uint block = bounce * BLOCKS_PER_EVENT;
  vec3 direct = direct_light(e, key, block, path.tally);
  path.radiance += path.throughput * direct;
  learn_scattering(path, bounce, direct, next);
  if (next.weight == vec3(0.0)) return false;
  float by_value = survival_by_value(path, e, bounce);
  path.throughput *= next.weight;
  path.roulette *= next.roulette;
  path.origin = ray_origin(e.surface, next.direction.direction);
  path.direction = next.direction.direction;
  path.pdf = next.direction.pdf;
  path.entry = next.direction.entry;
  path.share = next.direction.share;
  path.weight = average(next.weight);
  path.cell = cell_of(e);
  if (bounce + 1u > parameters.path.y) {
    float survival = by_value > 0.0 ? by_value : survival_by_reflectance(path);
    if (to_unit(random_bits(key, block + BLOCK_LIGHT).w) >= survival) return false;
    path.throughput /= survival;
    path.roulette /= survival;
    learn_survival(bounce, survival);
  }
  return true;
}

Event event_at(inout Path path, Hit hit) {
  Event e;
  e.surface = surface_at(hit, path.direction);
  e.bsdf = bsdf_of(e.surface.material);
  e.wo = -path.direction;
  return e;
}

// For directions, for what the last of these teaches, or for lights.
bool needs_cell(uint bounce) {
  return LIGHT_COLUMNS > 0 || float(bounce) < parameters.shaping.z ||
         (frame_teaches != 0u && float(bounce) == parameters.shaping.z);
}

// The event's cell, and where the path goes from there.
Departure depart_from(inout Path path, inout Event e, uint bounce, RandomKey key) {
#ifdef HAS_TABLE
  e.cell = no_cell(e.surface);
  if (needs_cell(bounce)) {
    e.cell = find_cell(e.surface);
    ++path.tally.lookups;
    if (e.cell.index == NO_CELL) ++path.tally.fallbacks;
  }
#endif
#if SAMPLER == SAMPLER_RL
  e.is_guided = e.cell.index != NO_CELL && float(bounce) < parameters.shaping.z;
  e.bsdf_share = bsdf_share_of(e);
#endif
  return depart(e, key, bounce);
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
  path.lesson = -1.0;
  path.tally = Tally(0u, 0u, 0u, 0u, 0u, 0u);

  // With two_ray, the last event's light needs no further ray of the path.
  uint last_ray = parameters.path.x - (NEE == NEE_TWO_RAY && parameters.path.x > 0u ? 1u : 0u);
  uint bounce = 0u;
  bool going_on = true;
  do {
    if (going_on) {
      ++path.tally.rays;
      ++path.tally.segments;
      Taught taught = Taught(path.entry, path.share, path.weight);
      Hit hit = closest_hit(path.origin, path.direction);
      if (hit.triangle == NO_TRIANGLE) {
        leave_scene(path, bounce);
        going_on = false;
      } else {
        Event e = event_at(path, hit);
        bool scatters = bounce < parameters.path.x;
        Departure next;
        if (scatters || ENDS_TEACH) next = depart_from(path, e, bounce, key);
        arrive(path, e, next, hit.t, bounce, scatters, key);
        going_on = scatters && scatter(path, e, next, bounce, key) && bounce < last_ray;
      }
      learn_lesson(path, taught);
      ++bounce;
    }
  } while (going_on);
  loop_was_cut = loop_was_cut || going_on;
  learn_path(path);
  // A throughput that broke without meeting light would pass unnoticed.
  if (!is_finite(average(path.throughput))) path.radiance = path.throughput;
  return path;
}
