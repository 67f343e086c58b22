// Nodes with both of their children in them, boxes in 16 bits a corner on a grid over the scene, rounded outwards by
// more than the tests below can be wrong (WideNode in structs.glsl).
#include "geometry/intersect.glsl"
#include "geometry/scene.glsl"
#include "shared/fetch.glsl"
#include "shared/structs.glsl"

layout(std140, binding = BINDING_NODE_GRID) uniform NodeGridBlock { NodeGrid node_grid; };

// t where the ray crosses a plane of the grid: plane * slope + start.
struct GridRay {
  vec3 slope;
  vec3 start;
};

GridRay grid_ray(vec3 origin, vec3 direction) {
  vec3 slope = safe_inverse(direction * node_grid.scale.xyz);
  return GridRay(slope, -((origin - node_grid.lo.xyz) * node_grid.scale.xyz) * slope);
}

// The bits of t where the ray enters the box, NO_CHILD where it does not. Integers are compared, which is cheaper than
// floats with their NaN: bits of floats that are not negative are in the order of the floats, and all negative ones,
// in whatever order, are below.
const int NO_CHILD = 0x7fffffff;

int enter_box(GridRay ray, uvec3 corners, int t_max) {
  ivec3 t0 = floatBitsToInt(fma(vec3(ivec3(corners & 0xffffu)), ray.slope, ray.start));
  ivec3 t1 = floatBitsToInt(fma(vec3(ivec3(corners >> 16u)), ray.slope, ray.start));
  ivec3 near = min(t0, t1);
  ivec3 far = max(t0, t1);
  int enter = max(max(near.x, near.y), max(near.z, 0));
  int leave = min(min(far.x, far.y), min(far.z, t_max));
  return enter <= leave ? enter : NO_CHILD;
}

// A link to a node is its index; to a leaf, LEAF_LINK | first triangle << LEAF_BITS | triangles. END_OF_WALK is no leaf.
bool is_leaf(uint link) {
  return link >= LEAF_LINK;
}

// What a node's children leave to do for a ray that has come as far as t_max.
struct Descent {
  uint nearer;
  uint farther;
  bool any;   // of them is met
  bool both;
};

Descent descend(GridRay ray, uint link, float t_max) {
  COUNT_STEP(nodes);
  uvec4 a = fetch(nodes, 2u * link);
  uvec4 b = fetch(nodes, 2u * link + 1u);
  int first = enter_box(ray, a.xyz, floatBitsToInt(t_max));
  int second = enter_box(ray, uvec3(a.w, b.xy), floatBitsToInt(t_max));
  bool swap = second < first;
  return Descent(swap ? b.w : b.z, swap ? b.z : b.w, min(first, second) != NO_CHILD, max(first, second) != NO_CHILD);
}

uint first_triangle(uint leaf) {
  return (leaf & ~LEAF_LINK) >> LEAF_BITS;
}

uint triangles_of(uint leaf) {
  return leaf & ((1u << LEAF_BITS) - 1u);
}
