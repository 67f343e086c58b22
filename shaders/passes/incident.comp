#version 450 core
// What arrives from all directions at the surface behind the centre of pixel (PIXEL_X, PIXEL_Y), which belongs to a
// cell: the hemisphere about its normal as a square image of HEMISPHERE_SIZE, one path for each pixel of it.
#include "geometry/camera.glsl"
#include "geometry/surface.glsl"
#include "learning/bins.glsl"
#include "learning/cells.glsl"
#include "path/trace.glsl"
#include "sampling/meeting.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer IncidentBuffer { Incident incidents[]; };

// Of the unit disk that the image shows: x along the cell's tangent, y upwards.
vec2 to_disk(vec2 position) {
  vec2 p = position * (2.0 / float(HEMISPHERE_SIZE)) - 1.0;
  return vec2(p.x, -p.y);
}

// Lambert's azimuthal equal-area projection, the horizon at radius 1 (Snyder 1987, "Map Projections - A Working
// Manual", p. 185): equal areas of the disk are equal solid angles.
vec3 from_disk(vec2 p) {
  float r2 = dot(p, p);
  return vec3(p * sqrt(max(0.0, 2.0 - r2)), 1.0 - r2);
}

uint bin_on_disk(vec2 p) {
  return dot(p, p) < 1.0 ? bin_of(from_disk(p)) : NO_BIN;
}

vec3 incident_radiance(RandomKey key, Surface s, vec3 local) {
  vec3 direction = to_world(local, find_cell(s).tangent, s.normal);
  vec3 radiance = trace(key, ray_origin(s, direction), direction).radiance;
  return is_finite(average(radiance)) ? radiance : vec3(0.0);
}

void main() {
  uvec2 pixel = pixel_of_invocation();
  if (any(greaterThanEqual(pixel, uvec2(HEMISPHERE_SIZE)))) return;
  uint index = pixel.y * uint(HEMISPHERE_SIZE) + pixel.x;
  RandomKey key = RandomKey(index, frame_number, parameters.seed);
  CameraRay view = camera_ray(vec2(PIXEL_X, PIXEL_Y) + 0.5);
  Surface s = met_surface(meet_half_opaque(view.origin, view.direction), view.direction);
  vec2 p = to_disk(vec2(pixel) + random_units(key, BLOCK_CAMERA).xy);
  uint bin = bin_on_disk(p);
  vec3 radiance = bin == NO_BIN ? vec3(0.0) : incident_radiance(key, s, from_disk(p));
  incidents[index].radiance = radiance;
  incidents[index].bin_cosine = bin == NO_BIN ? 0.0 : bin_cosine(bin);
  incidents[index].centre_bin = bin_on_disk(to_disk(vec2(pixel) + 0.5));
  incidents[index].path_bin = bin;
  if (loop_was_cut) report_cut(pixel);
}
