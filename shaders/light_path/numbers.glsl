// The random words of a light path. Its start draws from points that fill the dimensions of a frame evenly over all paths of
// the frame: the first two of Sobol's, Owen-scrambled and shuffled anew for every frame and for each pair of numbers (Burley
// 2020, "Practical Hash-based Owen Scrambling"). What follows draws independent numbers from blocks of its own.
#include "sampling/owen.glsl"
#include "sampling/path_bits.glsl"
#include "sampling/random.glsl"
#include "shared/structs.glsl"

// Point i of Sobol's second dimension.
uint second_dimension(uint i) {
  uint x = 0u;
  uint column = 0x80000000u;
  for (uint bit = 0u; bit < 32u; ++bit) {
    if ((i >> bit & 1u) != 0u) x ^= column;
    column ^= column >> 1u;
  }
  return x;
}

// The two numbers of a path that belong together; `block` tells pairs apart.
uvec2 stratified_pair(uint path, uint frame, uint seed, uint block) {
  uvec4 seeds = pcg4d(uvec4(block, frame, BLOCKS_OF_LIGHT_PATHS, seed));
  seeds ^= seeds >> 16u;
  // Shuffling is a scramble of the index, from its highest digit on. Of its bits reversed, the first dimension is made.
  uint index = scrambled(uvec4(bitfieldReverse(path)), seeds.zzzz).x;
  return scrambled(uvec4(index, bitfieldReverse(second_dimension(index)), 0u, 0u), seeds).xy;
}

struct StartNumbers {
  uvec4 light;     // words: light, triangle, point, point
  vec2 direction;  // in [0, 1)
};

StartNumbers start_numbers(uint path, uint frame, uint seed) {
  uvec2 direction = stratified_pair(path, frame, seed, 2u);
  return StartNumbers(uvec4(stratified_pair(path, frame, seed, 0u), stratified_pair(path, frame, seed, 1u)),
                      vec2(to_unit(direction.x), to_unit(direction.y)));
}

// Of the event of that number, from 0.
EventBits light_event_bits(RandomKey key, uint bounce) {
  return independent_bits(key, BLOCKS_OF_LIGHT_PATHS + bounce * BLOCKS_PER_EVENT);
}
