// Owen-scrambled Sobol' points: of a run of 2^k frames, the points of a pixel fill every box that is made by halving
// dimensions of a block k times in all. Which point of the sequence a frame uses is the same for all pixels, so the host
// computes it (engine/tracer/sobol.h); here each pixel scrambles its digits in a way of its own.
#include "sampling/random.glsl"
#include "shared/parameters.glsl"

// Keeps the keys of scrambles apart from those of independent numbers.
const uint SCRAMBLE = 0x80000000u;

// Nested uniform scrambling (Owen 1995) by a hash in which a bit depends on itself and lower ones alone (Laine & Karras
// 2011; the constants: Vegdahl 2021, "Building a Better LK Hash"). The digits come with the first one lowest, as the
// hash needs them, and leave with the first one highest.
uvec4 scrambled(uvec4 reversed, uvec4 seeds) {
  uvec4 x = reversed;
  x ^= x * 0x3d20adeau;
  x += seeds;
  x *= (seeds >> 16u) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return bitfieldReverse(x);
}

uvec4 sobol_bits(RandomKey key, uint block) {
  uvec4 seeds = pcg4d(uvec4(key.pixel, frame_sequence, block | SCRAMBLE, key.seed));
  // The first digits take the seed's low bits, which pcg4d leaves less random than its high ones.
  return scrambled(sobol_points[block], seeds ^ (seeds >> 16u));
}
