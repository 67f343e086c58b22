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

// A space in which the ray is the z axis, and t is z: Woop, Benthin & Wald 2013, "Watertight Ray/Triangle
// Intersection", JCGT 2(1).
struct Shear {
  uint axis;   // the largest of the direction's components, which becomes z
  vec3 slope;  // x / z and y / z of the direction, and 1 / z
};

vec3 turned(vec3 v, uint axis) {
  return axis == 0u ? v.yzx : axis == 1u ? v.zxy : v;
}

Shear shear_of(vec3 direction) {
  vec3 size = abs(direction);
  uint axis = size.x >= size.y && size.x >= size.z ? 0u : size.y >= size.z ? 1u : 2u;
  vec3 d = turned(direction, axis);
  return Shear(axis, vec3(d.x, d.y, 1.0) / d.z);
}

// To the bit the same for every triangle that has this vertex.
vec3 sheared(vec3 vertex, vec3 origin, Shear shear) {
  vec3 p = turned(vertex - origin, shear.axis);
  precise float x = p.x - shear.slope.x * p.z;
  precise float y = p.y - shear.slope.y * p.z;
  return vec3(x, y, p.z * shear.slope.z);
}

// Twice the signed area of the origin, p and q: exactly the negative where q and p change places.
float edge_function(vec3 p, vec3 q) {
  precise float area = p.x * q.y - p.y * q.x;
  return area;
}

// Either side is hit, edges and corners included, so that no ray passes between neighbours; t in (0, hit.t).
void test_triangle(vec3 origin, Shear shear, uint triangle, inout Hit hit) {
  vec3 a = sheared(vertex_of(triangle, 0u), origin, shear);
  vec3 b = sheared(vertex_of(triangle, 1u), origin, shear);
  vec3 c = sheared(vertex_of(triangle, 2u), origin, shear);
  vec3 weights = vec3(edge_function(c, b), edge_function(a, c), edge_function(b, a));
  bool inside = all(greaterThanEqual(weights, vec3(0.0))) || all(lessThanEqual(weights, vec3(0.0)));
  weights /= weights.x + weights.y + weights.z;
  float t = dot(weights, vec3(a.z, b.z, c.z));
  // A triangle that is seen edge on gives infinities or NaN, for which a comparison here is false.
  if (inside && t > 0.0 && t < hit.t) hit = Hit(t, triangle, weights.yz);
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
