#version 450 core
// One pass of the edge-avoiding a-trous wavelet transform: a 5 x 5 B3 spline whose taps stand apart, each
// weighted by how alike the two pixels are in radiance, normal and position.
// Dammertz, Sewtz, Hanika, Lensch 2010, "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination
// Filtering", HPG, section 3.
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(std140, binding = BINDING_PARAMETERS) uniform PassBlock { FilterPass constants; };
layout(std430, binding = BINDING_FILTER_GUIDES) restrict readonly buffer GuideBuffer { FilterGuide guides[]; };
// rgb: radiance / albedo, w: 1 where the pixel takes part, else 0.
layout(std430, binding = BINDING_FILTER_SOURCE) restrict readonly buffer SourceBuffer { vec4 source[]; };
layout(std430, binding = BINDING_FILTER_RESULT) restrict writeonly buffer ResultBuffer { vec4 result[]; };

const float SPLINE[3] = float[](3.0 / 8.0, 1.0 / 4.0, 1.0 / 16.0);  // by distance from the middle
const float MOST_EXPONENT = 80.0;  // beyond it, exp(-x) leaves the range of a float

float squared_length(vec3 v) {
  return dot(v, v);
}

// Product of the edge-stopping functions. `alike`: the channels that mix.
float likeness(uint p, uint q, vec3 alike) {
  float x = squared_length((source[p].rgb - source[q].rgb) * alike) * constants.radiance_falloff +
            squared_length(guides[p].normal.xyz - guides[q].normal.xyz) * constants.normal_falloff +
            squared_length(guides[p].position.xyz - guides[q].position.xyz) * constants.position_falloff;
  return x < MOST_EXPONENT ? exp(-x) : 0.0;
}

void main() {
  uint p = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  ivec2 size = ivec2(constants.image_size);
  if (p >= constants.image_size.x * constants.image_size.y) return;
  ivec2 pixel = ivec2(p % constants.image_size.x, p / constants.image_size.x);
  vec3 sum = vec3(0.0);
  vec3 weights = vec3(0.0);
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      ivec2 tap = pixel + int(constants.spacing) * ivec2(i, j);
      if (all(greaterThanEqual(tap, ivec2(0))) && all(lessThan(tap, size))) {
        uint q = uint(tap.y * size.x + tap.x);
        // A channel that was divided by its albedo says nothing to one that was not.
        vec3 alike = source[q].w * (1.0 - abs(guides[p].divided.rgb - guides[q].divided.rgb));
        vec3 weight = SPLINE[abs(i)] * SPLINE[abs(j)] * likeness(p, q, alike) * alike;
        sum += weight * source[q].rgb;
        weights += weight;
      }
    }
  }
  // The middle tap alone gives every pixel that takes part a weight.
  result[p] = source[p].w > 0.0 ? vec4(sum / weights, source[p].w) : source[p];
}
