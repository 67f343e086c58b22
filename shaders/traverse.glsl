// Ray queries: stackless traversal with hit and miss links (the report, section 4.1).
#include "scene.glsl"

struct Hit {
  float t;        // in units of the direction; the given maximum where nothing was hit
  uint triangle;  // NO_TRIANGLE where nothing was hit
  vec2 barycentric;  // weights of the second and third vertex
};

// A direction's components are kept away from zero so that no 0 * infinity arises in the slab test. The
// smallest normal float is about 1.2e-38; 1e-30 leaves room for coordinates up to 1e8.
vec3 safe_inverse(vec3 direction) {
  const float tiny = 1e-30;
  vec3 magnitude = max(abs(direction), vec3(tiny));
  return 1.0 / mix(magnitude, -magnitude, lessThan(direction, vec3(0.0)));
}

// Slab test. The far side is widened by the rounding of one subtraction and one product on either side
// (Ize 2013, "Robust BVH Ray Traversal"), so that a flat box is not missed.
bool meets_box(vec3 origin, vec3 inverse, vec3 lo, vec3 hi, float t_max) {
  vec3 t0 = (lo - origin) * inverse;
  vec3 t1 = (hi - origin) * inverse;
  vec3 near = min(t0, t1);
  vec3 far = max(t0, t1) * 1.00000048;
  return max(max(near.x, near.y), max(near.z, 0.0)) <= min(min(far.x, far.y), min(far.z, t_max));
}

// Moeller & Trumbore 1997. Either side is hit; t in (0, hit.t).
void test_triangle(vec3 origin, vec3 direction, uint triangle, inout Hit hit) {
  vec3 edge1 = shapes[triangle].edge1.xyz;
  vec3 edge2 = shapes[triangle].edge2.xyz;
  vec3 p = cross(direction, edge2);
  float inverse_det = 1.0 / dot(edge1, p);
  vec3 s = origin - shapes[triangle].vertex.xyz;
  float u = dot(s, p) * inverse_det;
  vec3 q = cross(s, edge1);
  float v = dot(direction, q) * inverse_det;
  float t = dot(edge2, q) * inverse_det;
  // A parallel ray gives infinities or NaN, for which a comparison here is false.
  if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < hit.t) hit = Hit(t, triangle, vec2(u, v));
}

// Walks to the next leaf whose box the ray meets and returns its packed range of triangles; 0 at the end.
// `node` is left behind that leaf.
// The body stands in an `if`, here and in every loop whose lanes end at different turns: llvmpipe (Mesa 22.3)
// computes a value that leaves a loop again in the later turns of other lanes, unless a branch guards it.
uint next_leaf(vec3 origin, vec3 inverse, float t_max, inout uint node) {
  uint leaf = 0u;
  bool searching = true;
  do {
    if (searching) {
      vec4 lo = nodes[node].lo;
      vec4 hi = nodes[node].hi;
      bool inside = meets_box(origin, inverse, lo.xyz, hi.xyz, t_max);
      uint range = floatBitsToUint(lo.w);
      leaf = inside ? range : 0u;
      node = inside && range == 0u ? node + 1u : floatBitsToUint(hi.w);
      searching = leaf == 0u && node != NO_NODE;
    }
  } while (searching);
  return leaf;
}

void traverse(vec3 origin, vec3 direction, bool any_hit, inout Hit hit) {
  vec3 inverse = safe_inverse(direction);
  uint node = 0u;
  bool searching = true;
  do {
    uint leaf = next_leaf(origin, inverse, hit.t, node);
    uint triangle = leaf >> LEAF_BITS;
    uint end = triangle + (leaf & ((1u << LEAF_BITS) - 1u));
    bool more = triangle < end;
    do {
      if (more) test_triangle(origin, direction, triangle, hit);
      ++triangle;
      more = more && triangle < end;
    } while (more);
    searching = node != NO_NODE && !(any_hit && hit.triangle != NO_TRIANGLE);
    loop_was_cut = loop_was_cut || (leaf == 0u && node != NO_NODE) || triangle < end;
  } while (searching);
  loop_was_cut = loop_was_cut || searching;
}

// The nearest hit at t in (0, infinity); `direction` need not be unit.
Hit closest_hit(vec3 origin, vec3 direction) {
  Hit hit = Hit(INFINITY, NO_TRIANGLE, vec2(0.0));
  traverse(origin, direction, false, hit);
  return hit;
}

// Whether anything stands at t in (0, 1).
bool is_occluded(vec3 origin, vec3 direction) {
  Hit hit = Hit(1.0, NO_TRIANGLE, vec2(0.0));
  traverse(origin, direction, true, hit);
  return hit.triangle != NO_TRIANGLE;
}
