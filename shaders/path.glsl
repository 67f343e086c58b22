// A path from its first ray on: at most max_bounces scattering events. Its radiance is what arrives at the ray's
// origin, the emission that the first ray meets included.
#include "nee.glsl"

struct Path {
  vec3 origin;
  vec3 direction;
  vec3 throughput;
  vec3 radiance;
  float pdf;   // of `direction`, per solid angle
  int cell;    // of the surface that it left, NO_CELL where it has none
  uint entry;  // of the Q-table that chose `direction`
  Tally tally;
};

#include "learning.glsl"

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
void arrive(inout Path path, Event e, Departure next, float t, uint bounce, RandomKey key) {
  vec3 emitted = emitted_radiance(e.surface);
  float weight =
      bounce == 0u ? 1.0 : emission_weight(e.surface, t, path.direction, path.pdf, path.cell);
  path.radiance += path.throughput * emitted * weight;
  learn_arriving(path, e, next, bounce, emitted, weight, key);
}

// Survival probability of Russian roulette: at most 0.95, as in the report, so that paths end also where
// nothing is absorbed.
const float MAX_SURVIVAL = 0.95;

// One scattering event. Returns whether the path goes on.
bool scatter(inout Path path, Event e, Departure next, uint bounce, RandomKey key) {
  uint block = bounce * BLOCKS_PER_EVENT;
  vec3 direct = direct_light(e, key, block, path.tally);
  path.radiance += path.throughput * direct;
  learn_scattering(bounce, direct, next);
  if (next.weight == vec3(0.0)) return false;
  path.throughput *= next.weight;
  path.origin = ray_origin(e.surface, next.direction.direction);
  path.direction = next.direction.direction;
  path.pdf = next.direction.pdf;
  path.entry = next.direction.entry;
  path.cell = cell_of(e);
  if (bounce + 1u > parameters.path.y) {
    float survival = min(max_component(path.throughput), MAX_SURVIVAL);
    if (to_unit(random_bits(key, block + BLOCK_LIGHT).w) >= survival) return false;
    path.throughput /= survival;
    learn_survival(bounce, survival);
  }
  return true;
}

Event event_at(inout Path path, Hit hit) {
  Event e;
  e.surface = surface_at(hit, path.direction);
  e.bsdf = bsdf_of(e.surface.material);
  e.wo = -path.direction;
#ifdef HAS_TABLE
  e.cell = find_cell(e.surface);
  ++path.tally.lookups;
  if (e.cell.index == NO_CELL) ++path.tally.fallbacks;
#endif
  return e;
}

Path trace(RandomKey key, vec3 origin, vec3 direction) {
  Path path;
  path.origin = origin;
  path.direction = direction;
  path.throughput = vec3(1.0);
  path.radiance = vec3(0.0);
  path.pdf = 0.0;
  path.cell = NO_CELL;
  path.entry = NO_ENTRY;
  path.tally = Tally(0u, 0u, 0u, 0u, 0u, 0u);

  // With two_ray, the last event's light needs no further ray of the path.
  uint last_ray = parameters.path.x - (NEE == NEE_TWO_RAY && parameters.path.x > 0u ? 1u : 0u);
  uint bounce = 0u;
  bool going_on = true;
  do {
    if (going_on) {
      ++path.tally.rays;
      ++path.tally.segments;
      Hit hit = closest_hit(path.origin, path.direction);
      if (hit.triangle == NO_TRIANGLE) {
        leave_scene(path, bounce);
        going_on = false;
      } else {
        Event e = event_at(path, hit);
        // Drawn also where the path ends: a rule may learn from it.
        Departure next = depart(e, key, bounce);
        arrive(path, e, next, hit.t, bounce, key);
        going_on = bounce < parameters.path.x && scatter(path, e, next, bounce, key) && bounce < last_ray;
      }
      ++bounce;
    }
  } while (going_on);
  loop_was_cut = loop_was_cut || going_on;
  learn_path(path);
  // A throughput that broke without meeting light would pass unnoticed.
  if (!is_finite(average(path.throughput))) path.radiance = path.throughput;
  return path;
}
