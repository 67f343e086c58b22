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

// Blocks of four numbers: one for the camera, then BLOCKS_PER_EVENT for every scattering event.
const uint BLOCK_CAMERA = 0u;
const uint BLOCK_DIRECTION = 1u;  // mixture choice, direction, direction, lobe or bin
const uint BLOCK_LIGHT = 2u;      // light, point, point, Russian roulette
const uint BLOCK_TWO_RAY = 3u;    // unused, direction, direction, lobe
const uint BLOCK_MORE = 4u;       // triangle of the light, rotation of the expectation (three)
const uint BLOCKS_PER_EVENT = 4u;

uvec4 random_bits(RandomKey key, uint block) {
  return pcg4d(uvec4(key.pixel, key.frame, block, key.seed));
}

// In [0, 1): 24 bits, all of them multiples of 2^-24.
float to_unit(uint bits) {
  return float(bits >> 8u) * (1.0 / 16777216.0);
}

vec4 random_units(RandomKey key, uint block) {
  uvec4 bits = random_bits(key, block);
  return vec4(to_unit(bits.x), to_unit(bits.y), to_unit(bits.z), to_unit(bits.w));
}
