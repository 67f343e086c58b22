// Counter-based random numbers: a pure function of (seed, pixel, frame, block), so that neither the order of
// threads nor the size of a batch changes a sample. pcg4d: Jarzynski & Olano 2020, "Hash Functions for GPU
// Rendering", JCGT 9(3), listing in the supplement.

uvec4 pcg4d(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

struct RandomKey {
  uint pixel;
  uint frame;
  uint seed;
};

uvec4 random_bits(RandomKey key, uint block) {
  return pcg4d(uvec4(key.pixel, key.frame, block, key.seed));
}

// In [0, 1): 24 bits, all of them multiples of 2^-24.
float to_unit(uint bits) {
  return float(bits >> 8u) * (1.0 / 16777216.0);
}

vec4 to_units(uvec4 bits) {
  return vec4(to_unit(bits.x), to_unit(bits.y), to_unit(bits.z), to_unit(bits.w));
}

vec4 random_units(RandomKey key, uint block) {
  return to_units(random_bits(key, block));
}
