// An event of a light path as the camera's paths would draw it.
#include "light/lights.glsl"
#include "mis/path_sums.glsl"
#include "mis/seen_from.glsl"
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "sampling/state.glsl"
#include "shared/counters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

// In that side's cell of the table.
Event seen_by_camera(Event e, vec3 viewer, inout Tally tally) {
  Event seen = seen_from(e, viewer);
  find_state(seen, tally, true, true);
  return seen;
}

// Of the camera's techniques, which reach the event by the direction that `seen` is seen from (path_sums.glsl). `light`: that
// of LightVertex.
float drawn_by_camera(Event e, Event seen, uint light) {
  if (light != NO_LIGHT) e.sums.last *= light_probability(cell_of(seen), light);
  float reverse = e.sums.chain > 0.0 ? direction_pdf(seen, e.wo) : 0.0;
  return drawn_from_behind(e, reverse);
}
