// Direction bins: BINS_THETA x BINS_PHI patches of the hemisphere about a normal, equal in solid angle, because
// a map that keeps areas takes the unit square there. Bin (j, k) has index j * BINS_PHI + k and covers
// [j, j + 1) / BINS_THETA x [k, k + 1) / BINS_PHI of the square.
#include "shared/math.glsl"
#include "shared/variants.glsl"

const int BINS = BINS_THETA * BINS_PHI;
const float BIN_SOLID_ANGLE = 2.0 * PI / float(BINS);

#if BIN_MAP == BIN_MAP_CYLINDRICAL

// (cos(theta), phi / 2 pi): Archimedes' map, as in Goswami 2020.
vec2 to_square(vec3 local) {
  float turn = atan(local.y, local.x) * (0.5 / PI);
  return vec2(local.z, turn < 0.0 ? turn + 1.0 : turn);
}

vec3 from_square(vec2 p) {
  float phi = 2.0 * PI * p.y;
  float sine = sqrt(max(0.0, 1.0 - p.x * p.x));
  return vec3(sine * cos(phi), sine * sin(phi), p.x);
}

// Of a direction in proportion to its cosine.
vec2 cosine_square(vec2 u) {
  return vec2(sqrt(1.0 - u.x), u.y);
}

// Mean cosine over a bin: cos(theta) is uniform over its row.
float bin_cosine(uint bin) {
  return (float(bin / uint(BINS_PHI)) + 0.5) / float(BINS_THETA);
}

#else

// Shirley & Chiu 1997, "A Low Distortion Map Between Disk and Square", then the disk to the hemisphere by
// cos(theta) = 1 - r^2.
vec2 to_square(vec3 local) {
  float r = sqrt(max(0.0, 1.0 - local.z));
  vec2 a = abs(local.xy);
  bool along_x = a.x >= a.y;
  float part = atan(min(a.x, a.y), max(a.x, a.y)) * (4.0 / PI);
  vec2 p = r * (along_x ? vec2(1.0, part) : vec2(part, 1.0));
  return 0.5 + 0.5 * mix(p, -p, lessThan(local.xy, vec2(0.0)));
}

vec3 from_square(vec2 p) {
  vec2 q = 2.0 * p - 1.0;
  vec2 a = abs(q);
  bool along_x = a.x >= a.y;
  float r = max(a.x, a.y);
  float phi = r > 0.0 ? (PI / 4.0) * min(a.x, a.y) / r : 0.0;
  vec2 unit = along_x ? vec2(cos(phi), sin(phi)) : vec2(sin(phi), cos(phi));
  vec2 signed_unit = mix(unit, -unit, lessThan(q, vec2(0.0)));
  return vec3(signed_unit * (r * sqrt(max(0.0, 2.0 - r * r))), 1.0 - r * r);
}

// Of a direction in proportion to its cosine.
vec2 cosine_square(vec2 u) {
  float phi = 2.0 * PI * u.y;
  return to_square(vec3(sqrt(u.x) * vec2(cos(phi), sin(phi)), sqrt(1.0 - u.x)));
}

// Integral of max(|x|, |y|)^2 = r^2 over the rectangle from 0 to `corner`.
float radius2_integral(vec2 corner) {
  vec2 a = abs(corner);
  float longer = max(a.x, a.y);
  float shorter = min(a.x, a.y);
  float integral = longer * longer * longer * shorter / 3.0 + shorter * shorter * shorter * shorter / 6.0;
  return corner.x * corner.y < 0.0 ? -integral : integral;
}

// Mean of cos(theta) = 1 - r^2 over a bin.
float bin_cosine(uint bin) {
  vec2 size = 2.0 / vec2(BINS_THETA, BINS_PHI);
  vec2 low = vec2(bin / uint(BINS_PHI), bin % uint(BINS_PHI)) * size - 1.0;
  vec2 high = low + size;
  float integral = radius2_integral(high) - radius2_integral(vec2(low.x, high.y)) -
                   radius2_integral(vec2(high.x, low.y)) + radius2_integral(low);
  return 1.0 - integral / (size.x * size.y);
}

#endif

uint bin_at(vec2 p) {
  uint j = uint(clamp(int(p.x * float(BINS_THETA)), 0, BINS_THETA - 1));
  uint k = uint(clamp(int(p.y * float(BINS_PHI)), 0, BINS_PHI - 1));
  return j * uint(BINS_PHI) + k;
}

uint bin_of(vec3 local) {
  return bin_at(to_square(local));
}

// At fraction u of the bin's part of the square.
vec2 square_in_bin(uint bin, vec2 u) {
  vec2 corner = vec2(bin / uint(BINS_PHI), bin % uint(BINS_PHI));
  return (corner + u) / vec2(BINS_THETA, BINS_PHI);
}

// Uniform in the bin for uniform u.
vec3 direction_in_bin(uint bin, vec2 u) {
  return from_square(square_in_bin(bin, u));
}
