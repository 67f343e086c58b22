#version 450 core
// One sample per pixel: a path from the camera, at most max_bounces scattering events.
#include "variants.glsl"
#include "random.glsl"
#include "nee.glsl"
#include "camera.glsl"
#include "statistics.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_SAMPLES) restrict writeonly buffer SampleBuffer { PixelSample samples[]; };

struct Path {
  vec3 origin;
  vec3 direction;
  vec3 throughput;
  vec3 radiance;
  float pdf;    // of `direction`, per solid angle
  uint entry;   // of the Q-table that chose `direction`
  uint rays;
  uint segments;
  uint lookups;
  uint fallbacks;
  uint updates;
  uint saturated;
};

void learn(inout Path path, float target) {
#if SAMPLER == SAMPLER_RL
  // A target that is not finite belongs to a sample that is reported.
  if (path.entry != NO_ENTRY && is_finite(target)) {
    ++path.updates;
    if (gather_target(path.entry, target)) ++path.saturated;
  }
#endif
}

void leave_scene(inout Path path, bool is_camera_ray) {
#ifdef HAS_ENVIRONMENT
  bool counted = NEE == NEE_TWO_RAY && !is_camera_ray;
  if (!counted) path.radiance += path.throughput * parameters.environment.rgb;
#endif
  learn(path, average(parameters.environment.rgb));
}

// Emission at the hit, and the lesson of the ray that led here.
void arrive(inout Path path, Event e, float t, bool is_camera_ray) {
  vec3 emitted = emitted_radiance(e.surface);
  float weight = is_camera_ray ? 1.0 : emission_weight(e.surface, t, path.direction, path.pdf);
  path.radiance += path.throughput * emitted * weight;
#if SAMPLER == SAMPLER_RL
  float next = e.cell.index == NO_CELL ? 0.0 : next_value(e.surface, e.bsdf, e.wo, e.cell);
  learn(path, average(emitted) + next);
#endif
}

// Survival probability of Russian roulette: at most 0.95, as in the report, so that paths end also where
// nothing is absorbed.
const float MAX_SURVIVAL = 0.95;

// One scattering event. Returns whether the path goes on.
bool scatter(inout Path path, Event e, uint bounce, RandomKey key) {
  uint block = bounce * BLOCKS_PER_EVENT;
  path.radiance += path.throughput * direct_light(e, key, block, path.rays);
  DirectionSample next = sample_direction(e, random_bits(key, block + BLOCK_DIRECTION));
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, next.direction);
  if (reflected == vec3(0.0)) return false;
  path.throughput *= reflected / next.pdf;
  path.origin = ray_origin(e.surface, next.direction);
  path.direction = next.direction;
  path.pdf = next.pdf;
  path.entry = next.entry;
  if (bounce + 1u > parameters.path.y) {
    float survival = min(max_component(path.throughput), MAX_SURVIVAL);
    if (to_unit(random_bits(key, block + BLOCK_LIGHT).w) >= survival) return false;
    path.throughput /= survival;
  }
  return true;
}

Event event_at(inout Path path, Hit hit) {
  Event e;
  e.surface = surface_at(hit, path.direction);
  e.bsdf = bsdf_of(e.surface.material);
  e.wo = -path.direction;
#if SAMPLER == SAMPLER_RL
  e.cell = find_cell(e.surface);
  ++path.lookups;
  if (e.cell.index == NO_CELL) ++path.fallbacks;
#endif
  return e;
}

Path trace(RandomKey key, vec2 position) {
  Path path;
  path.origin = parameters.camera_origin.xyz;
  path.direction = camera_direction(position);
  path.throughput = vec3(1.0);
  path.radiance = vec3(0.0);
  path.pdf = 0.0;
  path.entry = NO_ENTRY;
  path.rays = 0u;
  path.segments = 0u;
  path.lookups = 0u;
  path.fallbacks = 0u;
  path.updates = 0u;
  path.saturated = 0u;

  // With two_ray, the last event's light needs no further ray of the path.
  uint last_ray = parameters.path.x - (NEE == NEE_TWO_RAY && parameters.path.x > 0u ? 1u : 0u);
  uint bounce = 0u;
  bool going_on = true;
  do {
    if (going_on) {
      ++path.rays;
      ++path.segments;
      Hit hit = closest_hit(path.origin, path.direction);
      if (hit.triangle == NO_TRIANGLE) {
        leave_scene(path, bounce == 0u);
        going_on = false;
      } else {
        Event e = event_at(path, hit);
        arrive(path, e, hit.t, bounce == 0u);
        going_on = bounce < parameters.path.x && scatter(path, e, bounce, key) && bounce < last_ray;
      }
      ++bounce;
    }
  } while (going_on);
  loop_was_cut = loop_was_cut || going_on;
  // A throughput that broke without meeting light would pass unnoticed.
  if (!is_finite(average(path.throughput))) path.radiance = path.throughput;
  return path;
}

void main() {
  uvec2 pixel = pixel_of_invocation();
  if (any(greaterThanEqual(pixel, parameters.image.xy))) return;
  uint index = pixel.y * parameters.image.x + pixel.x;
  RandomKey key = RandomKey(index, frame_number, parameters.image.z);
  vec2 jitter = random_units(key, BLOCK_CAMERA).xy;
  Path path = trace(key, vec2(pixel) + jitter);
  samples[index].radiance = vec4(path.radiance, 0.0);
  samples[index].counts = uvec4(path.rays, path.segments, path.lookups | (path.fallbacks << 16u),
                                path.updates | (path.saturated << 16u));
  if (loop_was_cut) report_cut(pixel);
}
