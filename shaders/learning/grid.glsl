// Cells of a regular grid of boxes, six in each: for the axes that the normal towards the viewer can be nearest
// to (engine/cells/grid.h). Not every box has them; a hit without a cell is counted as one.
#include "geometry/surface.glsl"
#include "learning/cell.glsl"
#include "shared/fetch.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"

FETCHED_UINT(grid_states, UNIT_GRID_STATES);

Cell find_cell(Surface s) {
  uvec3 boxes = parameters.grid_boxes;
  vec3 place = max((s.position - parameters.grid_origin) * parameters.grid_boxes_per_unit, vec3(0.0));
  uvec3 box = min(uvec3(place), boxes - 1u);
  uint axis = nearest_axis(s.normal);
  uint state = fetch_one(grid_states, ((box.z * boxes.y + box.y) * boxes.x + box.x) * 6u + axis);
  if (state == NO_ENTRY) return no_cell(s);
  vec3 normal = vec3(equal(uvec3(axis >> 1), uvec3(0u, 1u, 2u))) * ((axis & 1u) == 0u ? 1.0 : -1.0);
  return cell_at(s, state, normal);
}
