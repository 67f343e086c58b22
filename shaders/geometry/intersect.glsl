// One ray and one triangle.
#include "geometry/scene.glsl"
#include "shared/structs.glsl"

#ifdef COUNTED  // by ./dev bench: what a walk visits
struct WalkSteps {
  uint nodes;
  uint triangles;
} walk_steps = WalkSteps(0u, 0u);
#define COUNT_STEP(member) ++walk_steps.member
#else
#define COUNT_STEP(member)
#endif

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
  COUNT_STEP(triangles);
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
