// The environment: constant, or an image in latitude and longitude (EnvironmentMap in engine/scene/lights.h).
#include "geometry/scene.glsl"
#include "shared/fetch.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

#ifdef HAS_SKY

const uint SKY_MEMBERS = 2u;

vec4 sky_texel(uint column, uint row) {
  return fetch(lights, parameters.sky_first + SKY_MEMBERS * (row * parameters.sky_size.x + column));
}

// In parts of the image: x of all longitudes, y of the angle from straight up.
vec2 sky_place(vec3 direction) {
  float turn = atan(direction.x, -direction.z) * (0.5 / PI) + 0.5 + parameters.sky_turn;
  // Straight up and down, the arc cosine would lose its digits.
  float angle = atan(length(direction.xz), direction.y);
  return vec2(fract(turn), angle * (1.0 / PI));
}

vec3 sky_direction(float turn, float cosine) {
  float phi = (turn - 0.5 - parameters.sky_turn) * (2.0 * PI);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  return vec3(sine * sin(phi), cosine, -sine * cos(phi));
}

uvec2 sky_cell(vec2 place) {
  return min(uvec2(place * vec2(parameters.sky_size)), parameters.sky_size - 1u);
}

vec3 sky_radiance(vec3 direction) {
  uvec2 size = parameters.sky_size;
  vec2 p = sky_place(direction) * vec2(size) - 0.5;
  vec2 low = floor(p);
  vec2 part = p - low;
  uint x0 = low.x < 0.0 ? size.x - 1u : min(uint(low.x), size.x - 1u);
  uint x1 = x0 + 1u < size.x ? x0 + 1u : 0u;
  uint y0 = uint(clamp(low.y, 0.0, float(size.y - 1u)));
  uint y1 = uint(clamp(low.y + 1.0, 0.0, float(size.y - 1u)));
  vec3 upper = mix(sky_texel(x0, y0).rgb, sky_texel(x1, y0).rgb, part.x);
  vec3 lower = mix(sky_texel(x0, y1).rgb, sky_texel(x1, y1).rgb, part.x);
  return mix(upper, lower, part.y);
}

// Density per solid angle of sample_sky().
float sky_pdf(vec3 direction) {
  uvec2 cell = sky_cell(sky_place(direction));
  return sky_texel(cell.x, cell.y).w;
}

struct SkySample {
  vec3 direction;
  float pdf;
};

// A texel by what its radiance brings, then a direction uniform in it. `words.x`: texel and longitude, y: the alias, z:
// latitude.
SkySample sample_sky(uvec3 words) {
  uvec2 size = parameters.sky_size;
  uint texel;
  uint rest;
  umulExtended(words.x, size.x * size.y, texel, rest);
  uvec4 link = floatBitsToUint(fetch(lights, parameters.sky_first + SKY_MEMBERS * texel + 1u));
  if (words.y > link.y) texel = link.x;
  uint row = texel / size.x;
  uint column = texel - row * size.x;
  float upper = cos(PI * float(row) / float(size.y));
  float lower = cos(PI * float(row + 1u) / float(size.y));
  float turn = (float(column) + float(rest >> 8u) * (1.0 / 16777216.0)) / float(size.x);
  float cosine = mix(upper, lower, float(words.z >> 8u) * (1.0 / 16777216.0));
  return SkySample(sky_direction(turn, cosine), sky_texel(column, row).w);
}

#endif

// Radiance of a ray that leaves the scene.
vec3 environment_radiance(vec3 direction) {
#ifdef HAS_SKY
  return sky_radiance(direction);
#else
  return parameters.environment;
#endif
}
