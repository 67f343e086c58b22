#version 450 core
// One sample per pixel: a path from the camera, at most max_bounces scattering events.
#include "geometry/camera.glsl"
#include "path/path.glsl"
#include "path/trace.glsl"
#include "sampling/path_bits.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_SAMPLES) restrict writeonly buffer SampleBuffer { PixelSample samples[]; };

void main() {
  uvec2 pixel = pixel_of_invocation();
  if (any(greaterThanEqual(pixel, parameters.image_size))) return;
  uint index = pixel.y * parameters.image_size.x + pixel.x;
  RandomKey key = RandomKey(index, frame_number, parameters.seed);
  vec2 jitter = camera_units(key);
  CameraRay ray = camera_ray(vec2(pixel) + jitter);
  Path path = trace(key, ray.origin, ray.direction);
  samples[index].radiance = vec4(path.radiance, 0.0);
  samples[index].counts = uvec4(path.tally.rays, path.tally.segments | (path.tally.connections << 16u),
                                path.tally.lookups | (path.tally.fallbacks << 16u),
                                path.tally.updates | (path.tally.saturated << 16u));
  if (loop_was_cut) report_cut(pixel);
}
