#version 450 core
// The table before anything is learned. One invocation per cell.
#include "geometry/scene.glsl"
#include "learning/table.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if SAMPLER == SAMPLER_RL
#include "learning/bins.glsl"
#endif

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_Q_VALUES) restrict writeonly buffer QValueBuffer { float q_values[]; };
layout(std430, binding = BINDING_Q_VISITS) restrict writeonly buffer QVisitBuffer { uint q_visits[]; };
layout(std430, binding = BINDING_CELL_PLACES) restrict readonly buffer CellPlaceBuffer { CellPlace places[]; };

// Apart from the random numbers of the paths, whose frames count from 1.
const uint FRAME_OF_TABLE = 0u;

#if SAMPLER == SAMPLER_RL

float initial_value(uint cell, uint bin) {
#if INITIAL_TABLE == INITIAL_CONSTANT
  return parameters.initial_value;
#elif INITIAL_TABLE == INITIAL_RANDOM
  return parameters.initial_value * random_units(RandomKey(cell, FRAME_OF_TABLE, parameters.seed), bin).x;
#elif INITIAL_TABLE == INITIAL_COSINE
  return parameters.initial_value * bin_cosine(bin);
#else
  return 0.0;
#endif
}

void initialize_bins(uint cell) {
  uint bin = 0u;
  do {
    q_values[first_bin(cell) + bin] = initial_value(cell, bin);
    q_visits[first_bin(cell) + bin] = 0u;
    ++bin;
  } while (bin < uint(BINS));
  loop_was_cut = loop_was_cut || bin < uint(BINS);
}

#endif

#if LIGHT_ACTIONS > 0

// A cell is no point and no plane: surfaces in it may face a light that its middle does not.
const float LEAST_COSINE = 0.1;
const float GUESSED_ALBEDO = 0.5;

#if defined(HAS_SKY) || defined(HAS_PUNCTUAL)
// The same of a light that no surface has: the sky by its mean radiance, from all sides.
float guess_without_surface(uint cell, uint light, float kind) {
  float contribution = GUESSED_ALBEDO * light_axis(light).w;
  if (kind != LIGHT_SKY) {
    vec3 way = kind == LIGHT_DIRECTIONAL ? -light_axis(light).xyz : light_centre(light).xyz - places[cell].position.xyz;
    float distance2 = max(dot(way, way), 1e-30);
    float cosine = max(dot(places[cell].normal.xyz, way) * inversesqrt(distance2), LEAST_COSINE);
    contribution *= cosine / PI;
    if (kind != LIGHT_DIRECTIONAL) contribution /= distance2;
  }
  return contribution * contribution;
}
#endif

// The square of what a light contributes if nothing hides it, seen from the cell's middle, in units of the brightest
// light: as the prior of Vevoda, Kondapaneni & Krivanek 2018, from a point for the light. What has no axis shows a
// quarter of its area to all sides.
float guess(uint cell, uint light) {
#if defined(HAS_SKY) || defined(HAS_PUNCTUAL)
  float kind = light_choice(light).z;
  if (kind != LIGHT_SURFACE) return guess_without_surface(cell, light, kind);
#endif
  vec3 to_light = light_centre(light).xyz - places[cell].position.xyz;
  float distance2 = max(dot(to_light, to_light), 1e-30);
  vec3 direction = to_light * inversesqrt(distance2);
  vec3 axis = light_axis(light).xyz;
  float area = light_centre(light).w;
  float shown = max(-dot(axis, direction), LEAST_COSINE * length(axis)) + 0.25 * max(1.0 - length(axis), 0.0);
  float cosine = max(dot(places[cell].normal.xyz, direction), LEAST_COSINE);
  float contribution =
      GUESSED_ALBEDO / PI * light_axis(light).w * area * shown * cosine / (distance2 + area);
  return contribution * contribution;
}

void initialize_lights(uint cell) {
  uint light = 0u;
  do {
    q_values[first_light(cell) + light] = parameters.light_prior > 0u ? guess(cell, light) : 0.0;
    q_visits[first_light(cell) + light] = parameters.light_prior;
    ++light;
  } while (light < uint(LIGHT_ACTIONS));
  loop_was_cut = loop_was_cut || light < uint(LIGHT_ACTIONS);
}

#endif

#ifdef LEARNS_MIXTURE

void initialize_mixture(uint cell) {
  for (uint side = SHARE_BSDF; side <= SHARE_TABLE; ++side) {
    q_values[first_share(cell) + side] = 0.0;
    q_visits[first_share(cell) + side] = 0u;
  }
}

#endif

void main() {
  uint cell = gl_WorkGroupID.x * LEARN_GROUP + gl_LocalInvocationID.x;
  if (cell >= parameters.cells) return;
#if SAMPLER == SAMPLER_RL
  initialize_bins(cell);
#endif
#ifdef LEARNS_MIXTURE
  initialize_mixture(cell);
#endif
#if LIGHT_ACTIONS > 0
  initialize_lights(cell);
#endif
  if (loop_was_cut) report_cut(uvec2(cell, 0u));
}
