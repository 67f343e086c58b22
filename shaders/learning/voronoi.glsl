// Voronoi cells (Goswami 2020, section 4.3.1): among the sites of the same object whose normal is close enough,
// the nearest; of equally near ones, the first. Front and back of a surface are cells of their own.
#include "geometry/surface.glsl"
#include "learning/cell.glsl"
#include "shared/fetch.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

FETCHED_VEC4(sites, UNIT_SITES);
// The ranges of the objects, in two elements each. Then entries, four in an element: place << LIST_COUNT_BITS | length
// of a list. Then the lists: xyz: bits of a position, w: its site within the object; before it, where not every normal
// of the surface in its box qualifies, an element with xyz: bits of the site's normal, w: LISTED_NORMAL.
FETCHED_UVEC4(site_lists, UNIT_SITE_LISTS);

SiteRange range_of(uint object) {
  return SiteRange(fetch(site_lists, 2u * object), uintBitsToFloat(fetch(site_lists, 2u * object + 1u)));
}

vec4 site_position(uint site) {
  return fetch(sites, 2u * site);
}

vec4 site_normal(uint site) {
  return fetch(sites, 2u * site + 1u);
}

struct Nearest {
  float distance2;  // infinity where no site qualifies
  uint site;        // counted within the object
};

// To the bit the same wherever it is called, as the cosine is.
float squared_distance(Surface s, vec3 position) {
  precise vec3 d = position - s.position;
  precise float distance2 = dot(d, d);
  return distance2;
}

bool qualifies(Surface s, vec3 normal) {
  precise float cosine = dot(normal, s.mesh_normal);
  return cosine > parameters.cell_normal_threshold;
}

// Of a site that qualifies, infinity else.
float site_distance2(Surface s, vec3 position, vec3 normal) {
  float distance2 = squared_distance(s, position);
  return qualifies(s, normal) ? distance2 : INFINITY;
}

#if SITE_SEARCH == SITE_SEARCH_LINEAR

// Four sites a turn: drivers may bound the turns of all loops together (shaders/README.md).
Nearest nearest_site(Surface s, SiteRange sites_of) {
  uint first = sites_of.range.x;
  uint count = sites_of.range.y;
  Nearest nearest = Nearest(INFINITY, 0u);
  uint site = 0u;
  bool more = count > 0u;
  do {
    if (more) {
      for (uint i = 0u; i < 4u; ++i) {
        uint candidate = min(site + i, count - 1u);
        uint place = first + candidate;
        float distance2 = site_distance2(s, site_position(place).xyz, site_normal(place).xyz);
        if (distance2 < nearest.distance2) nearest = Nearest(distance2, candidate);
      }
      site += 4u;
      more = site < count;
    }
  } while (more);
  loop_was_cut = loop_was_cut || site < count;
  return nearest;
}

#else

#if SITE_SEARCH == SITE_SEARCH_LISTS

// Entry of the box that the hit is in, and of the axis that its normal is nearest to; 0 where nothing is listed.
uint list_entry(Surface s, SiteRange sites_of) {
  const uvec3 shift = uvec3(0u, 1u, 2u) * LIST_BOX_BITS;
  uvec3 boxes = (uvec3(sites_of.range.w) >> shift) & ((1u << LIST_BOX_BITS) - 1u);
  if (boxes.x == 0u) return 0u;
  vec3 place = max((s.position - sites_of.frame.xyz) * sites_of.frame.w, vec3(0.0));
  uvec3 box = min(uvec3(place), boxes - 1u);
  uint entry = sites_of.range.z + ((box.z * boxes.y + box.y) * boxes.x + box.x) * 6u + nearest_axis(s.mesh_normal);
  return fetch(site_lists, entry >> 2)[entry & 3u];
}

// Looks through the list of the hit's box. Returns whether it has the site; else the tree is searched.
bool search_list(Surface s, SiteRange sites_of, inout Nearest nearest) {
  uint entry = list_entry(s, sites_of);
  uint place = entry >> LIST_COUNT_BITS;
  uint end = place + (entry & ((1u << LIST_COUNT_BITS) - 1u));
  bool more = place < end;
  bool fits = true;  // the next site
  do {
    if (more) {
      uvec4 listed = fetch(site_lists, place);
      vec3 vector = uintBitsToFloat(listed.xyz);
      bool is_site = listed.w != LISTED_NORMAL;
      float distance2 = squared_distance(s, vector);
      if (is_site && fits && distance2 < nearest.distance2) nearest = Nearest(distance2, listed.w);
      fits = is_site || qualifies(s, vector);
      ++place;
      more = place < end;
    }
  } while (more);
  loop_was_cut = loop_was_cut || place < end;
  return nearest.distance2 < INFINITY;
}

#endif

#ifdef LISTS_ARE_COMPLETE

Nearest nearest_site(Surface s, SiteRange sites_of) {
  Nearest nearest = Nearest(INFINITY, 0u);
  search_list(s, sites_of, nearest);
  return nearest;
}

#else

// What rounding can add to a cosine of normals, and take from a bound of it, is below some 1e-6.
const float COSINE_ROUNDING = 1e-5;

// Whether a site below a node may qualify: the largest cosine that the bounds of their normals allow.
bool may_qualify(Surface s, uint bounds) {
  const uvec3 shift = uvec3(0u, 1u, 2u) * NORMAL_BOUND_BITS;
  vec3 lo = vec3((uvec3(bounds) >> shift) & NORMAL_BOUND_STEPS);
  vec3 hi = vec3((uvec3(bounds) >> (shift + 3u * NORMAL_BOUND_BITS)) & NORMAL_BOUND_STEPS);
  vec3 scale = s.mesh_normal * (2.0 / float(NORMAL_BOUND_STEPS));
  vec3 cosines = max(lo * scale, hi * scale) - s.mesh_normal;
  return cosines.x + cosines.y + cosines.z + COSINE_ROUNDING > parameters.cell_normal_threshold;
}

// Wald 2022, "A Stack-Free Traversal Algorithm for Left-Balanced k-d Trees": node n, counted from 1, has the
// parent n / 2; whether a node is reached from above, from its near or from its far child tells what comes next.
// The far side is left out only if no site there can win: rounding is monotone, so that the rounded distance of
// none is below the rounded distance of the split. One just as near can still be the first.
Nearest nearest_site(Surface s, SiteRange sites_of) {
  uint first = sites_of.range.x;
  uint count = sites_of.range.y;
  Nearest nearest = Nearest(INFINITY, 0u);
#if SITE_SEARCH == SITE_SEARCH_LISTS
  if (search_list(s, sites_of, nearest)) count = 0u;
#endif
  uint previous = 0u;
  uint node = min(count, 1u);
  bool searching = node != 0u;
  do {
    if (searching) {
      vec4 position = site_position(first + node - 1u);
      vec4 normal = site_normal(first + node - 1u);
      bool is_new = previous < node;
      bool is_open = !is_new || may_qualify(s, floatBitsToUint(normal.w));
      if (is_new && is_open) {
        float distance2 = site_distance2(s, position.xyz, normal.xyz);
        bool is_first = distance2 == nearest.distance2 && node - 1u < nearest.site;
        if (distance2 < nearest.distance2 || is_first) nearest = Nearest(distance2, node - 1u);
      }
      uint axis = floatBitsToUint(position.w);
      precise vec3 d = s.position - position.xyz;
      float beyond = axis == 0u ? d.x : axis == 1u ? d.y : d.z;
      precise float beyond2 = beyond * beyond;
      uint near = 2u * node + (beyond > 0.0 ? 1u : 0u);
      uint far = near ^ 1u;
      uint next = node >> 1;
      if (is_new && is_open && near <= count) {
        next = near;
      } else if (is_open && previous != far && far <= count && beyond2 <= nearest.distance2) {
        next = far;
      }
      previous = node;
      node = next;
      searching = node != 0u;
    }
  } while (searching);
  loop_was_cut = loop_was_cut || node != 0u;
  return nearest;
}

#endif  // LISTS_ARE_COMPLETE

#endif

Cell find_cell(Surface s) {
  SiteRange sites_of = range_of(s.object);
  Nearest nearest = nearest_site(s, sites_of);
  if (nearest.distance2 == INFINITY) return no_cell(s);
  uint site = sites_of.range.x + nearest.site;
  return cell_at(s, 2u * site + (s.back ? 1u : 0u), site_normal(site).xyz);
}
