#version 450 core
// Adds a frame's samples to the sums of their pixels, and its counts to the counters.
#include "passes/pixel_sum.glsl"
#include "shared/counters.glsl"
#include "shared/fetch.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(location = LOCATION_WEIGHT) uniform float frame_weight;
FETCHED_UVEC4(samples, UNIT_SAMPLES);  // two elements for each pixel
// What is stored is fetched too (shaders/README.md): pixels belong to one invocation, which fetches before it stores.
FETCHED_UVEC4(outlier_texels, UNIT_OUTLIERS);  // two elements for each pixel
FETCHED_UVEC4(sum_texels, UNIT_SUMS);          // three elements for each pixel, two numbers in each
layout(std430, binding = BINDING_SUMS) writeonly buffer SumBuffer { uvec4 sum_words[]; };
layout(std430, binding = BINDING_OUTLIERS) buffer OutlierBuffer { PixelOutliers outliers[]; };

#ifdef HAS_LIGHT_PATHS
layout(std430, binding = BINDING_SPLATS) restrict buffer SplatBuffer { PixelSplat splats[]; };
layout(std430, binding = BINDING_LIGHT_PATHS) restrict readonly buffer LightPathBuffer { uvec4 light_path_counts[]; };
#endif

shared uint group_counts[COUNTER_PER_FRAME];

// What this invocation's pixels add.
uint fireflies = 0u;
uint clamped_samples = 0u;
uint light_rays = 0u;
uint splat_count = 0u;
uint connections = 0u;
uint counts[COUNTER_NON_FINITE];  // those before it

void judge_firefly(uint index, vec3 radiance) {
  float brightness = average(radiance);
  if (brightness <= uintBitsToFloat(fetch(outlier_texels, 2u * index + 1u).x)) return;
  ++fireflies;
  outliers[index].firefly_sum += double(frame_weight) * double(brightness);
  ++outliers[index].fireflies;
  if (brightness <= outliers[index].brightest) return;
  outliers[index].brightest = brightness;
  outliers[index].brightest_frame = frame_number;
}

// The sample, scaled down where its largest channel exceeds clamp_radiance; hue is kept.
vec3 clamped(uint index, vec3 radiance) {
  float limit = parameters.clamp_radiance;
  float largest = max_component(radiance);
  if (limit == 0.0 || largest <= limit) return radiance;
  vec3 kept = radiance / largest * limit;
  dvec3 removed = dvec3(radiance) - dvec3(kept);
  outliers[index].clamped_away += double(frame_weight) * (removed.r + removed.g + removed.b) / 3.0;
  ++clamped_samples;
  return kept;
}

void count_sample(uvec4 tally, bool is_zero) {
  counts[COUNTER_RAYS] += tally.x;
  counts[COUNTER_SEGMENTS] += tally.y & 0xffffu;
  connections += tally.y >> 16u;
  counts[COUNTER_ZERO_PATHS] += is_zero ? 1u : 0u;
  counts[COUNTER_LOOKUPS] += tally.z & 0xffffu;
  counts[COUNTER_FALLBACKS] += tally.z >> 16u;
  counts[COUNTER_UPDATES] += tally.w & 0xffffu;
  counts[COUNTER_SATURATED] += tally.w >> 16u;
}

#ifdef HAS_LIGHT_PATHS

float radiance_of(uvec2 words) {
  return float((double(words.y) * 4294967296.0LF + double(words.x)) * double(SPLAT_UNIT));
}

// What the frame's light paths brought to the pixel, which is left at zero for the next frame.
vec3 take_splat(uint index) {
  PixelSplat splat = splats[index];
  splats[index] = PixelSplat(uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u));
  return vec3(radiance_of(splat.red), radiance_of(splat.green), radiance_of(splat.blue)) /
         parameters.inverse_brightest;
}

// There may be more light paths than pixels: each pixel counts every so many-th of them.
void count_light_paths(uint index) {
  uint pixels = parameters.image_size.x * parameters.image_size.y;
  bool more = index < parameters.light_paths;
  do {
    if (more) {
      uvec4 tally = light_path_counts[index];
      counts[COUNTER_RAYS] += tally.x;
      light_rays += tally.x;
      splat_count += tally.y & 0xffffu;
      counts[COUNTER_LOOKUPS] += tally.z & 0xffffu;
      counts[COUNTER_FALLBACKS] += tally.z >> 16u;
      counts[COUNTER_SATURATED] += tally.w;
      index += pixels;
      more = index < parameters.light_paths;
    }
  } while (more);
  if (more) report_cut(uvec2(index, 0u));
}

#endif

void add_sample(uint index, vec3 radiance) {
  uvec4 a = fetch(sum_texels, 3u * index);
  uvec4 b = fetch(sum_texels, 3u * index + 1u);
  uvec4 c = fetch(sum_texels, 3u * index + 2u);
  PixelSum sum = with_sample(PixelSum(packDouble2x32(a.xy), packDouble2x32(a.zw), packDouble2x32(b.xy),
                                      packDouble2x32(b.zw), packDouble2x32(c.xy), packDouble2x32(c.zw)),
                             radiance, frame_weight);
  sum_words[3u * index] = uvec4(unpackDouble2x32(sum.r), unpackDouble2x32(sum.g));
  sum_words[3u * index + 1u] = uvec4(unpackDouble2x32(sum.b), unpackDouble2x32(sum.r_squared));
  sum_words[3u * index + 2u] = uvec4(unpackDouble2x32(sum.g_squared), unpackDouble2x32(sum.b_squared));
}

void add_pixel(uint index) {
  vec3 radiance = uintBitsToFloat(fetch(samples, 2u * index).rgb);
  bool is_zero = radiance == vec3(0.0);
#ifdef HAS_LIGHT_PATHS
  radiance += take_splat(index);
  count_light_paths(index);
#endif
  bool finite = is_finite(radiance.r) && is_finite(radiance.g) && is_finite(radiance.b);
  if (finite) {
    judge_firefly(index, radiance);
    add_sample(index, clamped(index, radiance));
  } else {
    report_non_finite(uvec2(index % parameters.image_size.x, index / parameters.image_size.x), frame_number);
  }
  count_sample(fetch(samples, 2u * index + 1u), is_zero);
}

// Each invocation takes every 64th of its group's pixels: counts are then shared once for all of them.
void main() {
  uint lane = gl_LocalInvocationID.x;
  if (lane < COUNTER_PER_FRAME) group_counts[lane] = 0u;
  for (uint i = 0u; i < COUNTER_NON_FINITE; ++i) counts[i] = 0u;
  barrier();
  uint pixels = parameters.image_size.x * parameters.image_size.y;
  uint index = gl_WorkGroupID.x * ACCUMULATE_GROUP_PIXELS + lane;
  uint end = min(index + ACCUMULATE_GROUP_PIXELS, pixels);
  bool more = index < end;
  do {
    if (more) {
      add_pixel(index);
      index += 64u;
      more = index < end;
    }
  } while (more);
  if (more) report_cut(uvec2(index, 0u));
  for (uint i = 0u; i < COUNTER_NON_FINITE; ++i) {
    if (counts[i] != 0u) atomicAdd(group_counts[i], counts[i]);
  }
  if (fireflies != 0u) atomicAdd(group_counts[COUNTER_FIREFLIES], fireflies);
  if (clamped_samples != 0u) atomicAdd(group_counts[COUNTER_CLAMPED], clamped_samples);
  if (light_rays != 0u) atomicAdd(group_counts[COUNTER_LIGHT_RAYS], light_rays);
  if (splat_count != 0u) atomicAdd(group_counts[COUNTER_SPLATS], splat_count);
  if (connections != 0u) atomicAdd(group_counts[COUNTER_CONNECTIONS], connections);
  barrier();
  if (lane < COUNTER_PER_FRAME) count(lane, group_counts[lane]);
}
