#version 450 core
// What the ray through each pixel's centre meets first.
#include "geometry/camera.glsl"
#include "geometry/surface.glsl"
#include "material/bsdf.glsl"
#include "material/emission.glsl"
#include "sampling/meeting.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer FirstHitBuffer { FirstHit first_hits[]; };

void main() {
  uvec2 pixel = pixel_of_invocation();
  if (any(greaterThanEqual(pixel, parameters.image_size))) return;
  CameraRay ray = camera_ray(vec2(pixel) + 0.5);
  Meeting met = meet_half_opaque(ray.origin, ray.direction);
  FirstHit first = FirstHit(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  if (met.hit.triangle != NO_TRIANGLE) {
    Surface s = met_surface(met, ray.direction);
    Bsdf b = bsdf_of(s, -ray.direction);
    first = FirstHit(vec4(s.normal, 0.0), vec4(s.position, 1.0), vec4(b.base_color, 1.0),
                     vec4(emitted_radiance(s, b), 1.0));
  }
  first_hits[pixel.y * parameters.image_size.x + pixel.x] = first;
  if (loop_was_cut) report_cut(pixel);
}
