// Voronoi cells (the report, section 4.3.1): among the sites of the same object whose normal is close enough,
// the nearest; of equally near ones, the first. Front and back of a surface are cells of their own.
layout(std430, binding = BINDING_SITES) restrict readonly buffer SiteBuffer { Site sites[]; };
layout(std430, binding = BINDING_SITE_RANGES) restrict readonly buffer SiteRangeBuffer { SiteRange site_ranges[]; };

struct Nearest {
  float distance2;  // infinity where no site qualifies
  uint site;        // counted within the object
};

// Distance of a site that qualifies, infinity else. To the bit the same wherever it is called.
float site_distance2(Surface s, Site site) {
  precise vec3 d = site.position.xyz - s.position;
  precise float distance2 = dot(d, d);
  precise float cosine = dot(site.normal.xyz, s.mesh_normal);
  return cosine > parameters.rl.z ? distance2 : INFINITY;
}

#if SITE_SEARCH == SITE_SEARCH_LINEAR

// Four sites a turn: drivers may bound the iterations of a shader (see loop_was_cut).
Nearest nearest_site(Surface s, SiteRange range) {
  Nearest nearest = Nearest(INFINITY, 0u);
  uint site = 0u;
  bool more = range.count > 0u;
  do {
    if (more) {
      for (uint i = 0u; i < 4u; ++i) {
        uint candidate = min(site + i, range.count - 1u);
        float distance2 = site_distance2(s, sites[range.first + candidate]);
        if (distance2 < nearest.distance2) nearest = Nearest(distance2, candidate);
      }
      site += 4u;
      more = site < range.count;
    }
  } while (more);
  loop_was_cut = loop_was_cut || site < range.count;
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
  return cosines.x + cosines.y + cosines.z + COSINE_ROUNDING > parameters.rl.z;
}

// Wald 2022, "A Stack-Free Traversal Algorithm for Left-Balanced k-d Trees": node n, counted from 1, has the
// parent n / 2; whether a node is reached from above, from its near or from its far child tells what comes next.
// The far side is left out only if no site there can win: rounding is monotone, so that the rounded distance of
// none is below the rounded distance of the split. One just as near can still be the first.
Nearest nearest_site(Surface s, SiteRange range) {
  Nearest nearest = Nearest(INFINITY, 0u);
  uint previous = 0u;
  uint node = min(range.count, 1u);
  bool searching = node != 0u;
  do {
    if (searching) {
      Site site = sites[range.first + node - 1u];
      bool is_new = previous < node;
      bool is_open = !is_new || may_qualify(s, floatBitsToUint(site.normal.w));
      if (is_new && is_open) {
        float distance2 = site_distance2(s, site);
        bool is_first = distance2 == nearest.distance2 && node - 1u < nearest.site;
        if (distance2 < nearest.distance2 || is_first) nearest = Nearest(distance2, node - 1u);
      }
      uint axis = floatBitsToUint(site.position.w);
      precise vec3 d = s.position - site.position.xyz;
      float beyond = axis == 0u ? d.x : axis == 1u ? d.y : d.z;
      precise float beyond2 = beyond * beyond;
      uint near = 2u * node + (beyond > 0.0 ? 1u : 0u);
      uint far = near ^ 1u;
      uint next = node >> 1;
      if (is_new && is_open && near <= range.count) {
        next = near;
      } else if (is_open && previous != far && far <= range.count && beyond2 <= nearest.distance2) {
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

#endif

Cell find_cell(Surface s) {
  SiteRange range = site_ranges[s.object];
  Nearest nearest = nearest_site(s, range);
  if (nearest.distance2 == INFINITY) return no_cell(s);
  uint site = range.first + nearest.site;
  return cell_at(s, 2u * site + (s.back ? 1u : 0u), sites[site].normal.xyz);
}
