// The random words of a path: blocks of four, one for the camera, then BLOCKS_PER_EVENT for every scattering event. With
// RANDOM_SOBOL those of the camera and of the first STRATIFIED_EVENTS events are Sobol' points, all others independent.
#include "sampling/random.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if RANDOM == RANDOM_SOBOL
#include "sampling/sobol.glsl"
#endif

struct EventBits {
  uvec4 direction;  // mixture choice, direction, direction, lobe or bin
  uvec4 light;      // light, point, point, Russian roulette
  uvec4 two_ray;    // surfaces that are passed, direction, direction, lobe
  uvec4 more;       // triangle of the light, rotation of the expectation (three)
};

// `block`: the first of its blocks.
EventBits independent_bits(RandomKey key, uint block) {
  return EventBits(random_bits(key, block + BLOCK_DIRECTION), random_bits(key, block + BLOCK_LIGHT),
                   random_bits(key, block + BLOCK_TWO_RAY), random_bits(key, block + BLOCK_MORE));
}

// For the surfaces that the ray before an event may pass.
uint passing_word(RandomKey key, uint bounce) {
#ifdef HAS_ALPHA
  return random_bits(key, BLOCKS_OF_PASSING + bounce).x;
#else
  return 0u;
#endif
}

#if RANDOM == RANDOM_SOBOL

vec2 camera_units(RandomKey key) {
  return to_units(sobol_bits(key, BLOCK_CAMERA)).xy;
}

// Made before a path's loop, where they cost once: in the loop they would cost at every event (shaders/README.md).
struct PathBits {
  EventBits stratified[STRATIFIED_EVENTS];
};

PathBits path_bits(RandomKey key) {
  PathBits bits;
  for (uint i = 0u; i < uint(STRATIFIED_EVENTS); ++i) {
    uint block = i * BLOCKS_PER_EVENT;
    bits.stratified[i] = EventBits(sobol_bits(key, block + BLOCK_DIRECTION), sobol_bits(key, block + BLOCK_LIGHT),
                                   sobol_bits(key, block + BLOCK_TWO_RAY), sobol_bits(key, block + BLOCK_MORE));
  }
  return bits;
}

EventBits event_bits(PathBits bits, RandomKey key, uint bounce) {
  EventBits chosen = independent_bits(key, bounce * BLOCKS_PER_EVENT);
  for (uint i = 0u; i < uint(STRATIFIED_EVENTS); ++i) {
    if (bounce == i) chosen = bits.stratified[i];
  }
  return chosen;
}

#else

vec2 camera_units(RandomKey key) {
  return random_units(key, BLOCK_CAMERA).xy;
}

struct PathBits {
  uint unused;
};

PathBits path_bits(RandomKey key) {
  return PathBits(0u);
}

EventBits event_bits(PathBits bits, RandomKey key, uint bounce) {
  return independent_bits(key, bounce * BLOCKS_PER_EVENT);
}

#endif
