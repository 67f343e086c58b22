// A cell, a state of the table, as a hit sees it.
#include "geometry/surface.glsl"
#include "shared/structs.glsl"

// Frame of a cell's directions at a hit: the normal, and a tangent that turns smoothly within the cell.
struct Cell {
  int index;  // state of the table, NO_CELL where the hit has none
  vec3 tangent;
};

// `normal`: of the cell.
Cell cell_at(Surface s, uint index, vec3 normal) {
  Cell cell = Cell(int(index), tangent_of(s.normal));
  vec3 t = tangent_of(normal);
  t -= dot(t, s.normal) * s.normal;
  // Only thresholds far below the usual let a cell's tangent be parallel to the normal of the hit.
  float length2 = dot(t, t);
  if (length2 > 1e-4) cell.tangent = t * inversesqrt(length2);
  return cell;
}

Cell no_cell(Surface s) {
  return Cell(NO_CELL, tangent_of(s.normal));
}

// x, -x, y, -y, z, -z.
uint nearest_axis(vec3 normal) {
  vec3 size = abs(normal);
  uint k = size.x >= size.y && size.x >= size.z ? 0u : size.y >= size.z ? 1u : 2u;
  float component = k == 0u ? normal.x : k == 1u ? normal.y : normal.z;
  return 2u * k + (component < 0.0 ? 1u : 0u);
}

vec3 to_cell(Cell cell, vec3 normal, vec3 direction) {
  return vec3(dot(direction, cell.tangent), dot(direction, cross(normal, cell.tangent)), dot(direction, normal));
}
