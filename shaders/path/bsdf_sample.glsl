// A direction drawn at a scattering event, and what the path's throughput takes from it.
#include "material/own_lobes.glsl"
#include "sampling/direction.glsl"
#include "shared/variants.glsl"

struct BsdfSample {
  DirectionSample direction;
  vec3 weight;  // f_r cos(theta) / pdf; zero where nothing is reflected that way
  vec3 roulette;  // the factor of what Russian roulette goes by
};

BsdfSample bsdf_sample_at(Event e, uvec4 bits) {
  BsdfSample next;
  next.direction = sample_direction(e, bits);
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, next.direction.direction);
  next.weight = reflected == vec3(0.0) ? vec3(0.0) : reflected / next.direction.pdf;
  next.roulette = next.weight;
#if SAMPLER == SAMPLER_RL && ROULETTE != ROULETTE_THROUGHPUT
  if (next.direction.bsdf > 0.0) next.roulette = reflected / next.direction.bsdf;
#endif
#ifdef HAS_OWN_LOBES
  if (next.direction.is_delta) {
    next.weight = next.direction.weight;
    next.roulette = next.weight;
  }
  // What a medium's index does to radiance says nothing of what the path is worth.
  next.roulette /= next.direction.compression;
#endif
  return next;
}
