// Where a light path starts: a light, a point on it or, for what is far away, of a disk across the scene, and a direction. The
// densities are those of emission_density.glsl.
#include "geometry/scene.glsl"
#include "geometry/surface.glsl"
#include "light/emission_density.glsl"
#include "light/lights.glsl"
#include "light/punctual.glsl"
#include "light/sky.glsl"
#include "light_path/numbers.glsl"
#include "sampling/random.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

struct LightStart {
  vec3 origin;
  vec3 direction;  // unit
  vec3 flux;       // radiance or intensity over the densities, what stands for cosines included
  float chain;     // of the paths from the camera that meet the light (PathSums)
  uint light;      // NO_LIGHT for the constant environment, which no light sample draws from
  float arrivals;  // density of starting so, per area that faces it at distance 1, or at any where it is far away
  bool is_far;
};

vec3 on_disk(vec2 u, vec3 direction) {
  float r = sqrt(u.x) * parameters.scene_radius;
  float phi = 2.0 * PI * u.y;
  vec3 tangent = tangent_of(direction);
  return to_world(vec3(r * cos(phi), r * sin(phi), 0.0), tangent, direction);
}

// Starts that far from the scene's centre, in its radii: just outside of it.
const float START_DISTANCE = 1.01;

// From far away, along `direction`, which was drawn with the density `pdf` after a choice with the probability `choice`.
LightStart start_from_afar(vec3 direction, vec3 radiance, float choice, float pdf, vec2 u) {
  LightStart start;
  start.direction = direction;
  start.origin = parameters.scene_centre + on_disk(u, direction) - START_DISTANCE * parameters.scene_radius * direction;
  start.arrivals = choice * parameters.disk_pdf;
  start.flux = radiance / (start.arrivals * pdf);
  start.chain = 1.0 / (start.arrivals * pdf);
  start.is_far = true;
  return start;
}

LightStart start_at_lamp(uint light, StartNumbers numbers) {
  LampPoint point = sample_lamp_point(light, numbers.light.y, numbers.light.zw);
  LightTriangle triangle = point.triangle;
  vec2 u = numbers.direction;
  float side = 1.0;
  if (triangle.radiance.w != EMITS_FRONT) {
    side = u.x < 0.5 ? 1.0 : -1.0;
    u.x = fract(2.0 * u.x);
  }
  vec3 normal = side * triangle.normal.xyz;

  LightStart start;
  start.direction = cosine_direction(u, normal);
  float cosine = dot(normal, start.direction);
  start.origin = point.position + triangle.edge1.w * normal;
  float pdf = lamp_emission_pdf(triangle);
  start.flux = cosine > 0.0 ? light_radiance(triangle, -start.direction, point.place) / pdf : vec3(0.0);
  start.chain = 1.0 / pdf;
  start.arrivals = emission_choice(light) * lamp_direction_pdf(triangle, cosine);
  start.is_far = false;
  return start;
}

// Uniform about an axis, from a cosine on.
vec3 direction_about(vec3 axis, float least_cosine, vec2 u) {
  float cosine = mix(1.0, least_cosine, u.x);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  float phi = 2.0 * PI * u.y;
  return to_world(vec3(sine * cos(phi), sine * sin(phi), cosine), tangent_of(axis), axis);
}

vec3 any_direction(vec2 u) {
  return direction_about(vec3(0.0, 0.0, 1.0), -1.0, u);
}

#ifdef HAS_PUNCTUAL
LightStart start_at_punctual(uint light, float kind, vec2 u) {
  LightStart start;
  if (kind == LIGHT_DIRECTIONAL) {
    start = start_from_afar(light_axis(light).xyz, light_intensity(light).rgb, emission_choice(light), 1.0, u);
  } else {
    float pdf = emission_choice(light) * punctual_direction_pdf(light, kind);
    start.direction =
        kind == LIGHT_SPOT ? direction_about(light_axis(light).xyz, spot_end(light), u) : any_direction(u);
    start.origin = light_centre(light).xyz;
    start.flux = light_intensity(light).rgb * (punctual_part(light, kind, start.direction) / pdf);
    start.arrivals = pdf;
    start.is_far = false;
  }
  start.chain = 0.0;  // no path from the camera meets it
  return start;
}
#endif

#ifdef HAS_SKY
LightStart start_at_sky(uint light, StartNumbers numbers) {
  SkySample sky = sample_sky(numbers.light.yzw);
  return start_from_afar(-sky.direction, sky_radiance(sky.direction), emission_choice(light), sky.pdf, numbers.direction);
}
#endif

LightStart start_at_constant_environment(StartNumbers numbers) {
  vec3 direction = any_direction(vec2(to_unit(numbers.light.z), to_unit(numbers.light.w)));
  LightStart start = start_from_afar(direction, parameters.environment, parameters.environment_share, 0.25 / PI,
                                     numbers.direction);
  start.light = NO_LIGHT;
  return start;
}

LightStart start_of(StartNumbers numbers) {
  // The choice between the environment and the others takes the lowest part of the word, which is then stretched again.
  float share = parameters.environment_share;
  float u = to_unit(numbers.light.x);
  if (u < share) return start_at_constant_environment(numbers);
  uint word = share > 0.0 ? uint(min((u - share) / (1.0 - share), 0.99999994) * 4294967296.0) : numbers.light.x;
  uint light = choose_light(NO_CELL, word);
  LightStart start;
#if defined(HAS_SKY) || defined(HAS_PUNCTUAL)
  float kind = light_choice(light).z;
  if (kind == LIGHT_SURFACE) start = start_at_lamp(light, numbers);
#ifdef HAS_SKY
  if (kind == LIGHT_SKY) start = start_at_sky(light, numbers);
#endif
#ifdef HAS_PUNCTUAL
  if (is_punctual(kind)) start = start_at_punctual(light, kind, numbers.direction);
#endif
#else
  start = start_at_lamp(light, numbers);
#endif
  start.light = light;
  return start;
}
