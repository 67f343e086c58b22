// A scattering event as the other end of its path sees it. Its normals, its lobes and its cell may differ from there: by the
// side of the surface, by a normal that faces away, by a coat.
#include "geometry/surface.glsl"
#include "material/bsdf.glsl"
#include "sampling/event.glsl"

// `viewer`: unit, from the surface. Without a cell.
Event seen_from(Event e, vec3 viewer) {
  Event seen = e;
  seen.surface = surface_at(e.hit, -viewer);
  seen.bsdf = bsdf_of(seen.surface, viewer);
  seen.wo = viewer;
  leave_table_out(seen);
  return seen;
}

// Between a direction and the triangle's own normal, by which densities per solid angle become densities per area. What is
// seen edge on has one of 1e-6 at least: no sum is infinite then, and both ends of a path see the same.
float face_cosine(Event e, vec3 direction) {
  return max(abs(dot(e.surface.geometric_normal, direction)), 1e-6);
}
