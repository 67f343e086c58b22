// Lights, and points on them. A light is chosen first, by a fixed rule or by what the cell has learned; then, of a surface,
// one of its triangles by power and a point uniform on it; of the sky, a direction.
#include "geometry/intersect.glsl"
#include "geometry/scene.glsl"
#include "geometry/surface.glsl"
#include "light/emission_density.glsl"
#include "light/punctual.glsl"
#include "light/sky.glsl"
#include "material/bsdf.glsl"
#include "material/emission.glsl"
#include "material/opacity.glsl"
#include "sampling/random.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if LIGHT_ACTIONS > 0
#include "learning/actions.glsl"
#include "learning/table.glsl"
#endif

struct LightSample {
  vec3 direction;     // from the surface to the point, unit
  vec3 radiance;      // towards the surface
  float pdf;          // per solid angle, the choice of the light included
  float probability;  // of that choice
  uint light;
  vec3 origin;        // shadow ray, from the light: neighbouring ones share more of their way than from the surface
  vec3 segment;       // to the surface, over t in (0, 1)
#ifdef HAS_ABSORPTION
  float distance;     // to the point
#endif
#ifdef HAS_PUNCTUAL
  bool is_punctual;   // paths cannot meet it
#endif
#ifdef HAS_LIGHT_PATHS
  float arrivals;     // density of light paths of this light that reach the surface from there, per area that faces it, over
                      // that of the light sample
#endif
};

// Walker's alias method: one look-up whatever the number of slots. The product of word and count holds the
// slot in its high word and the fraction in its low one, so that no digit serves twice.
uint alias_slot(uint word, uint count, out uint fraction) {
  uint slot;
  umulExtended(word, count, slot, fraction);
  return slot;
}

// `cell`: that of the surface, NO_CELL where it has none.
uint choose_light(int cell, uint word) {
#if LIGHT_ACTIONS > 0
  if (cell != NO_CELL) return choose_action(first_light(uint(cell)), uint(LIGHT_ACTIONS), word).action;
#endif
  uint fraction;
  uint slot = alias_slot(word, parameters.lights, fraction);
  uvec4 link = light_link(slot);
  return fraction <= link.z ? slot : link.x;
}

float light_probability(int cell, uint light) {
#if LIGHT_ACTIONS > 0
  if (cell != NO_CELL) return action_probability(first_light(uint(cell)), uint(LIGHT_ACTIONS), light);
#endif
  return light_choice(light).x;
}

uint choose_triangle(uint light, uint word) {
  uint fraction;
  uvec4 range = light_link(light);
  uint triangle = range.y + alias_slot(word, range.w, fraction);
  uvec4 link = light_triangle(triangle).link;
  return fraction <= link.z ? triangle : link.x;
}

// Density per solid angle, seen from distance `t` under `direction`, of the choice of this point on its light.
float point_pdf(LightTriangle triangle, float t, vec3 direction) {
  float cosine = abs(dot(triangle.normal.xyz, direction));
  return cosine > 0.0 ? triangle.edge2.w * t * t / cosine : 0.0;
}

// The same with the choice of the light, from a surface in `cell`.
float light_pdf(int cell, uint index, float t, vec3 direction) {
  LightTriangle triangle = light_triangle(index);
  return light_probability(cell, triangle.link.y) * point_pdf(triangle, t, direction);
}

// Radiance of a point of a light that is seen under `direction`, where its second and third corner count for `b`.
vec3 light_radiance(LightTriangle light, vec3 direction, vec2 b) {
#if HAS_TEXTURE(TEXTURE_EMISSION) || defined(HAS_ALPHA) || defined(HAS_CLEARCOAT)
  Surface s = surface_at(Hit(0.0, light.link.w, b), direction);
  return emitted_radiance(s, bsdf_of(s, -direction)) * opacity_of(s);
#else
  return light.radiance.rgb;
#endif
}

struct LampPoint {
  LightTriangle triangle;
  vec2 place;  // what its second and third corner count for
  vec3 position;
};

// On a light with a surface: one of its triangles by power, and a point uniform on it.
LampPoint sample_lamp_point(uint light, uint triangle_word, uvec2 words) {
  LampPoint point;
  point.triangle = light_triangle(choose_triangle(light, triangle_word));
  float along = to_unit(words.y);
  point.place = sqrt(to_unit(words.x)) * vec2(1.0 - along, along);
  point.position = point.triangle.vertex.xyz + point.place.x * point.triangle.edge1.xyz +
                   point.place.y * point.triangle.edge2.xyz;
  return point;
}

// Of the surface of `result.light`.
void sample_lamp(inout LightSample result, Surface s, uvec4 bits, uint triangle_word) {
  LampPoint point = sample_lamp_point(result.light, triangle_word, bits.yz);
  LightTriangle triangle = point.triangle;
  vec3 to_point = point.position - s.position;
  float t = length(to_point);
  vec3 normal = triangle.normal.xyz;

  result.direction = to_point / t;
  float facing = -dot(normal, result.direction);
  bool lit = t > 0.0 && (facing > 0.0 || (facing < 0.0 && triangle.radiance.w != EMITS_FRONT));
  result.radiance = lit ? light_radiance(triangle, result.direction, point.place) : vec3(0.0);
  result.pdf = lit ? result.probability * point_pdf(triangle, t, result.direction) : 0.0;
#ifdef HAS_LIGHT_PATHS
  result.arrivals = lamp_direction_pdf(triangle, facing) / (t * t);
#endif
  // The segment starts off the light on the side that is looked at. At its other end it stays off the surface by what the
  // test at t = 1 can round off: that grows with the coordinates of the surface and with the distance.
  result.origin = point.position + (facing < 0.0 ? -triangle.edge1.w : triangle.edge1.w) * normal;
  s.offset = max(s.offset, OFFSET_FRACTION * t);
  result.segment = ray_origin(s, result.direction) - result.origin;
#ifdef HAS_ABSORPTION
  result.distance = t;
#endif
}

#ifdef HAS_SKY
void sample_light_of_sky(inout LightSample result, Surface s, uvec4 bits, uint triangle_word) {
  SkySample sky = sample_sky(uvec3(triangle_word, bits.yz));
  result.direction = sky.direction;
  result.radiance = sky_radiance(sky.direction);
  result.pdf = result.probability * sky.pdf;
#ifdef HAS_LIGHT_PATHS
  result.arrivals = parameters.disk_pdf;
#endif
  result.origin = ray_origin(s, sky.direction);
  result.segment = parameters.reach * sky.direction;
#ifdef HAS_ABSORPTION
  result.distance = INFINITY;
#endif
}
#endif

#ifdef HAS_PUNCTUAL
// Its radiance over its density is the irradiance that it brings.
void sample_punctual(inout LightSample result, Surface s, float kind) {
  vec3 way = to_punctual(result.light, kind, s.position);
  float t = length(way);
  result.direction = way / t;
  result.radiance = t > 0.0 ? punctual_irradiance(result.light, kind, result.direction, t) : vec3(0.0);
  result.pdf = t > 0.0 ? result.probability : 0.0;
#ifdef HAS_LIGHT_PATHS
  result.arrivals =
      kind == LIGHT_DIRECTIONAL ? parameters.disk_pdf : punctual_direction_pdf(result.light, kind) / (t * t);
#endif
  s.offset = max(s.offset, OFFSET_FRACTION * t);
  result.origin = s.position + way;
  result.segment = ray_origin(s, result.direction) - result.origin;
#ifdef HAS_ABSORPTION
  result.distance = kind == LIGHT_DIRECTIONAL ? INFINITY : t;
#endif
}
#endif

// pdf is 0 where the point cannot send light here.
LightSample sample_light(Surface s, int cell, uvec4 bits, uint triangle_word) {
  LightSample result;
  result.light = choose_light(cell, bits.x);
  result.probability = light_probability(cell, result.light);
#if defined(HAS_SKY) || defined(HAS_PUNCTUAL)
  float kind = light_choice(result.light).z;
  if (kind == LIGHT_SURFACE) sample_lamp(result, s, bits, triangle_word);
#ifdef HAS_SKY
  if (kind == LIGHT_SKY) sample_light_of_sky(result, s, bits, triangle_word);
#endif
#ifdef HAS_PUNCTUAL
  result.is_punctual = is_punctual(kind);
  if (result.is_punctual) sample_punctual(result, s, kind);
#endif
#else
  sample_lamp(result, s, bits, triangle_word);
#endif
#ifdef HAS_LIGHT_PATHS
  result.arrivals *= emission_choice(result.light) / result.probability;
#endif
  return result;
}
