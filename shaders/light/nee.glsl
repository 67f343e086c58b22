// Next event estimation: direct light of a scattering event by sampling the lights.
#include "geometry/scene.glsl"
#include "geometry/surface.glsl"
#include "light/lights.glsl"
#include "light/medium.glsl"
#include "light/shadow.glsl"
#include "light/sky.glsl"
#include "material/bsdf.glsl"
#include "material/emission.glsl"
#include "material/own_lobes.glsl"
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "sampling/meeting.glsl"
#include "sampling/path_bits.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if LIGHT_ACTIONS > 0
#include "learning/gather.glsl"
#include "learning/table.glsl"
#endif
#ifdef HAS_LIGHT_PATHS
#include "light/emission_density.glsl"
#include "mis/path_sums.glsl"
#include "mis/seen_from.glsl"
#endif

// Power heuristic with exponent 2 for one sample of each (Veach 1997, section 9.2.4), kept from overflow.
float power_heuristic(float pdf, float other) {
  float ratio = other / pdf;
  return 1.0 / (1.0 + ratio * ratio);
}

// Weight of a light sample, both densities without the choice of the light or both with it.
float light_weight(LightSample light, float pdf, float other) {
#ifdef HAS_PUNCTUAL
  if (light.is_punctual) return 1.0;
#endif
  return power_heuristic(pdf, other);
}

#ifdef HAS_LIGHT_PATHS

// The same heuristic for one technique among three, where two have these densities over its own.
float weight_beside(float other, float third) {
  return 1.0 / (1.0 + other * other + third * third);
}

// Density of the light paths that make a path with this light sample, over its own.
float light_paths_over(Event e, LightSample light) {
  return light.arrivals * face_cosine(e, light.direction) * drawn_by_light_paths(e, light.direction);
}

float light_weight(Event e, LightSample light) {
  float met = direction_pdf(e, light.direction) / light.pdf;
#ifdef HAS_PUNCTUAL
  if (light.is_punctual) met = 0.0;
#endif
  return weight_beside(met, light_paths_over(e, light));
}

// Density of light paths from the environment, over that of a path that leaves the scene in this direction.
float sky_paths_over(float chain, vec3 direction) {
#ifdef HAS_SKY
  return chain * emission_choice(SKY_LIGHT) * sky_pdf(direction) * parameters.disk_pdf;
#else
  return chain * parameters.environment_share * (0.25 / PI) * parameters.disk_pdf;
#endif
}

#endif

// The target of a light's value, of light samples that are hidden, too: the square of what the light contributes once it
// is chosen. Choosing lights by the root of its mean minimises the variance of one choice (Kahn & Marshall 1953);
// Vevoda, Kondapaneni & Krivanek 2018 and Pantaleoni 2019 learn lights in this way. MIS weights are left out: they
// depend on the choice itself.
void gather_light(Event e, LightSample light, vec3 contribution, inout Tally tally) {
#if LIGHT_ACTIONS > 0
  uint entry = e.cell.index != NO_CELL ? first_light(uint(e.cell.index)) + light.light : NO_ENTRY;
  gather_square(tally, entry, average(contribution) * light.probability);
#endif
}

#if NEE != NEE_NONE

LightSample sample_event_light(Event e, EventBits bits) {
  return sample_light(e.surface, cell_of(e), bits.light, bits.more.x);
}

// What a light sample brings, before MIS: zero where it is hidden.
vec3 light_contribution(Event e, LightSample light, inout Tally tally) {
  vec3 reflected = bsdf_cosine(e.surface, e.bsdf, e.wo, light.direction) * light.radiance;
#ifdef HAS_ABSORPTION
  reflected *= left_after(medium_towards(e, light.direction), light.distance);
#endif
  vec3 contribution = vec3(0.0);
  if (light.pdf > 0.0 && reflected != vec3(0.0)) {
    float reaching = transmittance(light.origin, light.segment, tally.rays);
    if (reaching > 0.0) contribution = reflected / light.pdf * reaching;
  }
  gather_light(e, light, contribution, tally);
  return contribution;
}

#endif

#if NEE == NEE_ONE_RAY

// One light sample, weighted against the path's own sampler, which meets the same lights by its next ray.
vec3 direct_light(Event e, EventBits bits, inout Tally tally) {
  LightSample light = sample_event_light(e, bits);
  vec3 contribution = light_contribution(e, light, tally);
  if (contribution == vec3(0.0)) return contribution;
#ifdef HAS_LIGHT_PATHS
  return contribution * light_weight(e, light);
#else
  return contribution * light_weight(light, light.pdf, direction_pdf(e, light.direction));
#endif
}

// Weight of emission that the path's own ray met, which left a surface in `cell`. `chain`: of its sums (PathSums).
float emission_weight(Surface s, float t, vec3 direction, float path_pdf, int cell, float chain) {
  if (s.light == NO_LIGHT) return 1.0;
  float sampled = light_pdf(cell, s.light, t, direction);
#ifdef HAS_LIGHT_PATHS
  return weight_beside(sampled / path_pdf, chain * lamp_emission_pdf(light_triangle(s.light)));
#else
  return power_heuristic(path_pdf, sampled);
#endif
}

// Of the environment's radiance, likewise.
float environment_weight(vec3 direction, float path_pdf, int cell, float chain) {
#ifdef HAS_SKY
  float sampled = light_probability(cell, SKY_LIGHT) * sky_pdf(direction);
#else
  float sampled = 0.0;
#endif
#ifdef HAS_LIGHT_PATHS
  return weight_beside(sampled / path_pdf, sky_paths_over(chain, direction));
#elif defined(HAS_SKY)
  return power_heuristic(path_pdf, sampled);
#else
  return 1.0;
#endif
}

#elif NEE == NEE_TWO_RAY

// What a BSDF sample finds outside of the scene, with its weight: an image of the environment is a light as others are.
vec3 environment_of_choice(LightSample light, float pdf, vec3 direction) {
#ifdef HAS_SKY
  if (light.light != SKY_LIGHT) return vec3(0.0);
  return sky_radiance(direction) * power_heuristic(pdf, sky_pdf(direction)) / light.probability;
#else
  return parameters.environment;
#endif
}

// The BSDF sample of Goswami 2020: what it meets counts where it is the light that was chosen. Environment is met too.
vec3 bsdf_light(Event e, LightSample light, uvec4 bits, inout Tally tally) {
  BsdfDraw drawn = draw_bsdf(e, bits);
  vec3 wi = drawn.direction;
  vec3 result = vec3(0.0);
  if (drawn.pdf > 0.0 && drawn.weight != vec3(0.0)) {
    ++tally.rays;
    Meeting met = meet(ray_origin(e.surface, wi), wi, bits.x);
    tally.rays += met.passed;
    if (met.hit.triangle == NO_TRIANGLE) {
      result = drawn.weight * environment_of_choice(light, drawn.pdf, wi);
    } else {
      Surface other = met_surface(met, wi);
      LightTriangle triangle = light_triangle(other.light == NO_LIGHT ? 0u : other.light);
      if (other.light != NO_LIGHT && triangle.link.y == light.light) {
        float heuristic = power_heuristic(drawn.pdf, point_pdf(triangle, met.hit.t, wi));
        result = drawn.weight * emitted_radiance(other, bsdf_of(other, -wi)) * heuristic / light.probability;
      }
#ifdef HAS_UNLIT
      // What emits and is no light is found by this ray alone.
      if (other.light == NO_LIGHT) result = drawn.weight * emitted_radiance(other, bsdf_of(other, -wi));
#endif
    }
#ifdef HAS_ABSORPTION
    result *= left_after(medium_towards(e, wi), met.hit.t);
#endif
  }
  return result;
}

// That of Goswami 2020: a light sample and a BSDF sample towards the same light, power heuristic, both tested by a closest
// hit. The path's own rays count no emission.
vec3 direct_light(Event e, EventBits bits, inout Tally tally) {
  LightSample light = sample_event_light(e, bits);
  vec3 contribution = light_contribution(e, light, tally);
  vec3 result = bsdf_light(e, light, bits.two_ray, tally);
  if (contribution == vec3(0.0)) return result;
  float other = bsdf_pdf(e, light.direction);
  return result + contribution * light_weight(light, light.pdf / light.probability, other);
}

float emission_weight(Surface s, float t, vec3 direction, float path_pdf, int cell, float chain) {
  return 0.0;
}

float environment_weight(vec3 direction, float path_pdf, int cell, float chain) {
  return 0.0;
}

#else

vec3 direct_light(Event e, EventBits bits, inout Tally tally) {
  return vec3(0.0);
}

float emission_weight(Surface s, float t, vec3 direction, float path_pdf, int cell, float chain) {
#ifdef HAS_LIGHT_PATHS
  return s.light == NO_LIGHT ? 1.0 : weight_beside(0.0, chain * lamp_emission_pdf(light_triangle(s.light)));
#else
  return 1.0;
#endif
}

float environment_weight(vec3 direction, float path_pdf, int cell, float chain) {
#ifdef HAS_LIGHT_PATHS
  return weight_beside(0.0, sky_paths_over(chain, direction));
#else
  return 1.0;
#endif
}

#endif
