// Next event estimation: direct light of a scattering event by sampling the lights.
#include "lights.glsl"
#include "direction.glsl"

// Power heuristic with exponent 2 for one sample of each (Veach 1997, section 9.2.4), kept from overflow.
float power_heuristic(float pdf, float other) {
  float ratio = other / pdf;
  return 1.0 / (1.0 + ratio * ratio);
}

#if NEE == NEE_ONE_RAY

// One light sample, weighted against the path's own sampler, which meets the same lights by its next ray.
vec3 direct_light(Event e, RandomKey key, uint block, inout uint rays) {
  LightSample light = sample_light(e.surface, random_bits(key, block + BLOCK_LIGHT));
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, light.direction) * light.radiance;
  vec3 result = vec3(0.0);
  if (light.pdf > 0.0 && reflected != vec3(0.0)) {
    ++rays;
    if (!is_occluded(light.origin, light.segment)) {
      result = reflected * power_heuristic(light.pdf, direction_pdf(e, light.direction)) / light.pdf;
    }
  }
  return result;
}

// Weight of emission that the path's own ray met.
float emission_weight(Surface s, float t, vec3 direction, float path_pdf) {
  return s.light == NO_LIGHT ? 1.0 : power_heuristic(path_pdf, light_pdf(s.light, t, direction));
}

#elif NEE == NEE_TWO_RAY

// The report's: a light sample and a BSDF sample towards the same light (an object), power heuristic, both
// tested by a closest hit. The path's own rays count no emission. Environment is met by the BSDF sample.
vec3 direct_light(Event e, RandomKey key, uint block, inout uint rays) {
  LightSample light = sample_light(e.surface, random_bits(key, block + BLOCK_LIGHT));
  float share = lights[light.index].normal.w;
  vec3 result = vec3(0.0);
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, light.direction) * light.radiance;
  if (light.pdf > 0.0 && reflected != vec3(0.0)) {
    ++rays;
    if (closest_hit(light.origin, light.segment).t >= 1.0) {
      float other = bsdf_pdf(e.surface, e.bsdf, e.wo, light.direction);
      result = reflected * power_heuristic(light.pdf / share, other) / light.pdf;
    }
  }

  vec4 u = random_units(key, block + BLOCK_TWO_RAY);
  vec3 wi = sample_bsdf(e.surface, e.bsdf, e.wo, u.yz, u.w);
  float pdf = bsdf_pdf(e.surface, e.bsdf, e.wo, wi);
  vec3 weight = bsdf_cosine(e.surface, e.bsdf, e.wo, wi) / pdf;
  if (pdf > 0.0 && weight != vec3(0.0)) {
    ++rays;
    Hit hit = closest_hit(ray_origin(e.surface, wi), wi);
    if (hit.triangle == NO_TRIANGLE) {
      result += weight * parameters.environment.rgb;
    } else {
      Surface other = surface_at(hit, wi);
      if (other.light != NO_LIGHT && lights[other.light].link.y == lights[light.index].link.y) {
        float light_density = light_pdf(other.light, hit.t, wi) / share;
        result += weight * emitted_radiance(other) * power_heuristic(pdf, light_density) / share;
      }
    }
  }
  return result;
}

float emission_weight(Surface s, float t, vec3 direction, float path_pdf) {
  return 0.0;
}

#else

vec3 direct_light(Event e, RandomKey key, uint block, inout uint rays) {
  return vec3(0.0);
}

float emission_weight(Surface s, float t, vec3 direction, float path_pdf) {
  return 1.0;
}

#endif
