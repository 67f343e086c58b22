// Traversal without a stack, by hit and miss links (Goswami 2020, section 4.1).
#include "geometry/intersect.glsl"
#include "geometry/scene.glsl"
#include "shared/fetch.glsl"
#include "shared/loops.glsl"
#include "shared/structs.glsl"

// Slab test. The far side is widened by the rounding of one subtraction and one product on either side
// (Ize 2013, "Robust BVH Ray Traversal"), so that a flat box is not missed.
bool meets_box(vec3 origin, vec3 inverse, vec3 lo, vec3 hi, float t_max) {
  vec3 t0 = (lo - origin) * inverse;
  vec3 t1 = (hi - origin) * inverse;
  vec3 near = min(t0, t1);
  vec3 far = max(t0, t1) * 1.00000048;
  return max(max(near.x, near.y), max(near.z, 0.0)) <= min(min(far.x, far.y), min(far.z, t_max));
}

// Walks to the next leaf whose box the ray meets and returns its packed range of triangles; 0 at the end.
// `node` is left behind that leaf.
// Bodies stand in an `if` (shaders/README.md).
uint next_leaf(vec3 origin, vec3 inverse, float t_max, inout uint node) {
  uint leaf = 0u;
  bool searching = true;
  do {
    if (searching) {
      COUNT_STEP(nodes);
      vec4 lo = uintBitsToFloat(fetch(nodes, 2u * node));
      vec4 hi = uintBitsToFloat(fetch(nodes, 2u * node + 1u));
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
  Shear shear = shear_of(direction);
  uint node = 0u;
  bool searching = true;
  do {
    uint leaf = next_leaf(origin, inverse, hit.t, node);
    uint triangle = leaf >> LEAF_BITS;
    uint end = triangle + (leaf & ((1u << LEAF_BITS) - 1u));
    bool more = triangle < end;
    do {
      if (more) test_triangle(origin, shear, triangle, hit);
      ++triangle;
      more = more && triangle < end;
    } while (more);
    searching = node != NO_NODE && !(any_hit && hit.triangle != NO_TRIANGLE);
    loop_was_cut = loop_was_cut || (leaf == 0u && node != NO_NODE) || triangle < end;
  } while (searching);
  loop_was_cut = loop_was_cut || searching;
}
