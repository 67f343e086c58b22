#version 450 core
// Adds a frame's samples to the sums of their pixels, and its counts to the statistics.
#include "scene.glsl"
#include "statistics.glsl"
#include "pixel_sum.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_SAMPLES) restrict readonly buffer SampleBuffer { PixelSample samples[]; };
layout(std430, binding = BINDING_SUMS) restrict buffer SumBuffer { PixelSum sums[]; };
layout(std430, binding = BINDING_OUTLIERS) restrict buffer OutlierBuffer { PixelOutliers outliers[]; };

shared uint group_counts[STATISTIC_PER_FRAME];

void judge_firefly(uint index, vec3 radiance) {
  float brightness = average(radiance);
  if (brightness <= outliers[index].threshold) return;
  atomicAdd(group_counts[STATISTIC_FIREFLIES], 1u);
  outliers[index].firefly_sum += double(brightness);
  ++outliers[index].fireflies;
  if (brightness <= outliers[index].brightest) return;
  outliers[index].brightest = brightness;
  outliers[index].brightest_frame = frame_number;
}

// The sample, scaled down where its largest channel exceeds clamp_radiance; hue is kept.
vec3 clamped(uint index, vec3 radiance) {
  float limit = parameters.film.x;
  float largest = max_component(radiance);
  if (limit == 0.0 || largest <= limit) return radiance;
  vec3 kept = radiance / largest * limit;
  dvec3 removed = dvec3(radiance) - dvec3(kept);
  outliers[index].clamped_away += (removed.r + removed.g + removed.b) / 3.0;
  atomicAdd(group_counts[STATISTIC_CLAMPED], 1u);
  return kept;
}

void count_sample(uvec4 counts, bool is_zero) {
  atomicAdd(group_counts[STATISTIC_RAYS], counts.x);
  atomicAdd(group_counts[STATISTIC_SEGMENTS], counts.y);
  atomicAdd(group_counts[STATISTIC_ZERO_PATHS], is_zero ? 1u : 0u);
  atomicAdd(group_counts[STATISTIC_LOOKUPS], counts.z & 0xffffu);
  atomicAdd(group_counts[STATISTIC_FALLBACKS], counts.z >> 16u);
  atomicAdd(group_counts[STATISTIC_UPDATES], counts.w & 0xffffu);
  atomicAdd(group_counts[STATISTIC_SATURATED], counts.w >> 16u);
}

void main() {
  uint lane = gl_LocalInvocationID.x;
  if (lane < STATISTIC_PER_FRAME) group_counts[lane] = 0u;
  barrier();
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + lane;
  if (index < parameters.image.x * parameters.image.y) {
    vec3 radiance = samples[index].radiance.rgb;
    bool finite = is_finite(radiance.r) && is_finite(radiance.g) && is_finite(radiance.b);
    if (finite) {
      judge_firefly(index, radiance);
      sums[index] = with_sample(sums[index], clamped(index, radiance));
    }
    else report_non_finite(uvec2(index % parameters.image.x, index / parameters.image.x), frame_number);
    count_sample(samples[index].counts, radiance == vec3(0.0));
  }
  barrier();
  if (lane < STATISTIC_PER_FRAME) count(lane, group_counts[lane]);
}
