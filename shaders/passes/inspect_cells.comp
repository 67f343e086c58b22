#version 450 core
// The cell of what the ray through each pixel's centre meets first.
#include "geometry/camera.glsl"
#include "geometry/surface.glsl"
#include "learning/cells.glsl"
#include "sampling/meeting.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = BINDING_OUTPUT) restrict writeonly buffer PixelCellBuffer { int pixel_cells[]; };

void main() {
  uvec2 pixel = pixel_of_invocation();
  if (any(greaterThanEqual(pixel, parameters.image_size))) return;
  CameraRay ray = camera_ray(vec2(pixel) + 0.5);
  Meeting met = meet_half_opaque(ray.origin, ray.direction);
  int cell = NO_CELL;
  if (met.hit.triangle != NO_TRIANGLE) cell = find_cell(met_surface(met, ray.direction)).index;
  pixel_cells[pixel.y * parameters.image_size.x + pixel.x] = cell;
  if (loop_was_cut) report_cut(pixel);
}
