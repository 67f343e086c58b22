// Voronoi cells on the surfaces: the states of the Q-table (the report, section 4.3.1).
#include "surface.glsl"

layout(std430, binding = BINDING_SITES) restrict readonly buffer SiteBuffer { Site sites[]; };
layout(std430, binding = BINDING_SITE_RANGES) restrict readonly buffer SiteRangeBuffer { SiteRange site_ranges[]; };

const int NO_CELL = -1;

// Frame of a cell's directions at a hit: the normal, and a tangent that turns smoothly within the cell.
struct Cell {
  int index;  // row of the Q-table, NO_CELL where no site qualifies
  vec3 tangent;
};

// Distance of a site that qualifies, infinity else.
float site_distance2(Surface s, uint site) {
  vec3 d = sites[site].position.xyz - s.position;
  return dot(sites[site].normal.xyz, s.mesh_normal) > parameters.rl.z ? dot(d, d) : INFINITY;
}

// Among the sites of the same object whose normal is close enough, the nearest; of equally near ones, the
// first. Front and back of a surface are cells of their own. Four sites a turn: drivers may bound the
// iterations of a shader (see loop_was_cut).
Cell find_cell(Surface s) {
  uint site = site_ranges[s.object].first;
  uint last = site + site_ranges[s.object].count - 1u;
  float nearest = INFINITY;
  uint nearest_site = site;
  bool more = last != site - 1u;
  bool any_sites = more;
  do {
    if (more) {
      for (uint i = 0u; i < 4u; ++i) {
        uint candidate = min(site + i, last);
        float distance2 = site_distance2(s, candidate);
        nearest_site = distance2 < nearest ? candidate : nearest_site;
        nearest = min(nearest, distance2);
      }
      site += 4u;
      more = site <= last;
    }
  } while (more);
  loop_was_cut = loop_was_cut || (any_sites && site <= last);

  Cell cell = Cell(NO_CELL, tangent_of(s.normal));
  if (nearest < INFINITY) {
    cell.index = int(2u * nearest_site + (s.back ? 1u : 0u));
    vec3 t = tangent_of(sites[nearest_site].normal.xyz);
    t -= dot(t, s.normal) * s.normal;
    // Only thresholds far below the usual let a site's tangent be parallel to the normal of the hit.
    float length2 = dot(t, t);
    if (length2 > 1e-4) cell.tangent = t * inversesqrt(length2);
  }
  return cell;
}

vec3 to_cell(Cell cell, vec3 normal, vec3 direction) {
  return vec3(dot(direction, cell.tangent), dot(direction, cross(normal, cell.tangent)), dot(direction, normal));
}
