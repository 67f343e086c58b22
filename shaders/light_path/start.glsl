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

// From far away, along `direction`. `pdf`: of that direction, the choice of the light included.
LightStart start_from_afar(vec3 direction, vec3 radiance, float pdf, vec2 u) {
  LightStart start;
  start.direction = direction;
  start.origin = parameters.scene_centre + on_disk(u, direction) - START_DISTANCE * parameters.scene_radius * direction;
  start.flux = radiance / (pdf * parameters.disk_pdf);
  start.chain = 1.0 / (pdf * parameters.disk_pdf);
  start.is_far = true;
  return start;
}

LightStart start_at_lamp(uint light, StartBits bits) {
  LightTriangle triangle = light_triangle(choose_triangle(light, bits.light.y));
  float root = sqrt(to_unit(bits.light.z));
  float along = to_unit(bits.light.w);
  vec2 place = root * vec2(1.0 - along, along);
  vec2 u = vec2(to_unit(bits.direction.x), to_unit(bits.direction.y));
  float side = 1.0;
  if (triangle.radiance.w != EMITS_FRONT) {
    side = u.x < 0.5 ? 1.0 : -1.0;
    u.x = fract(2.0 * u.x);
  }
  vec3 normal = side * triangle.normal.xyz;

  LightStart start;
  start.direction = cosine_direction(u, normal);
  float cosine = dot(normal, start.direction);
  start.origin = triangle.vertex.xyz + place.x * triangle.edge1.xyz + place.y * triangle.edge2.xyz +
                 triangle.edge1.w * normal;
  float pdf = emission_choice(light) * triangle.edge2.w * emitting_side(triangle) / PI;  // over the cosine
  start.flux = cosine > 0.0 ? light_radiance(triangle, -start.direction, place) / pdf : vec3(0.0);
  start.chain = 1.0 / pdf;
  start.arrivals = emission_choice(light) * lamp_direction_pdf(triangle, cosine);
  start.is_far = false;
  return start;
}

#ifdef HAS_PUNCTUAL

// Uniform about an axis, from a cosine on.
vec3 direction_about(vec3 axis, float least_cosine, vec2 u) {
  float cosine = mix(1.0, least_cosine, u.x);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  float phi = 2.0 * PI * u.y;
  return to_world(vec3(sine * cos(phi), sine * sin(phi), cosine), tangent_of(axis), axis);
}

LightStart start_at_punctual(uint light, float kind, vec2 u) {
  LightStart start;
  if (kind == LIGHT_DIRECTIONAL) {
    start = start_from_afar(light_axis(light).xyz, light_intensity(light).rgb, emission_choice(light), u);
    start.arrivals = emission_choice(light) * parameters.disk_pdf;
  } else {
    vec3 axis = kind == LIGHT_SPOT ? light_axis(light).xyz : vec3(0.0, 0.0, 1.0);
    float pdf = emission_choice(light) * punctual_direction_pdf(light, kind);
    start.direction = direction_about(axis, kind == LIGHT_SPOT ? spot_end(light) : -1.0, u);
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
LightStart start_at_sky(uint light, StartBits bits) {
  SkySample sky = sample_sky(uvec3(bits.light.yzw));
  vec2 u = vec2(to_unit(bits.direction.x), to_unit(bits.direction.y));
  LightStart start = start_from_afar(-sky.direction, sky_radiance(sky.direction), emission_choice(light) * sky.pdf, u);
  start.arrivals = emission_choice(light) * parameters.disk_pdf;
  return start;
}
#endif

LightStart start_at_constant_environment(StartBits bits) {
  vec2 u = vec2(to_unit(bits.light.z), to_unit(bits.light.w));
  float cosine = 1.0 - 2.0 * u.x;
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  vec3 direction = vec3(sine * cos(2.0 * PI * u.y), sine * sin(2.0 * PI * u.y), cosine);
  vec2 place = vec2(to_unit(bits.direction.x), to_unit(bits.direction.y));
  LightStart start =
      start_from_afar(direction, parameters.environment, parameters.environment_share * (0.25 / PI), place);
  start.light = NO_LIGHT;
  start.arrivals = 0.0;
  return start;
}

LightStart start_of(StartBits bits) {
  // The choice between the environment and the others takes the lowest part of the word, which is then stretched again.
  float share = parameters.environment_share;
  float u = to_unit(bits.light.x);
  if (u < share) return start_at_constant_environment(bits);
  uint word = share > 0.0 ? uint(min((u - share) / (1.0 - share), 0.99999994) * 4294967296.0) : bits.light.x;
  uint light = choose_light(NO_CELL, word);
  LightStart start;
#if defined(HAS_SKY) || defined(HAS_PUNCTUAL)
  float kind = light_choice(light).z;
  if (kind == LIGHT_SURFACE) start = start_at_lamp(light, bits);
#ifdef HAS_SKY
  if (kind == LIGHT_SKY) start = start_at_sky(light, bits);
#endif
#ifdef HAS_PUNCTUAL
  if (is_punctual(kind))
    start = start_at_punctual(light, kind, vec2(to_unit(bits.direction.x), to_unit(bits.direction.y)));
#endif
#else
  start = start_at_lamp(light, bits);
#endif
  start.light = light;
  return start;
}
