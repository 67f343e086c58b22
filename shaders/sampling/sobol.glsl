// Owen-scrambled Sobol' points: of a run of 2^k frames, the points of a pixel fill every box that is made by halving
// dimensions of a block k times in all. Which point of the sequence a frame uses is the same for all pixels, so the host
// computes it (engine/tracer/sobol.h); here each pixel scrambles its digits in a way of its own.
#include "sampling/owen.glsl"
#include "sampling/random.glsl"
#include "shared/parameters.glsl"

// Keeps the keys of scrambles apart from those of independent numbers.
const uint SCRAMBLE = 0x80000000u;

uvec4 sobol_bits(RandomKey key, uint block) {
  uvec4 seeds = pcg4d(uvec4(key.pixel, frame_sequence, block | SCRAMBLE, key.seed));
  // The first digits take the seed's low bits, which pcg4d leaves less random than its high ones.
  return scrambled(sobol_points[block], seeds ^ (seeds >> 16u));
}
