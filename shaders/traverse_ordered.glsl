// Traversal with a stack, the nearer child first. Both children of a node lie in the node, their boxes in 16 bits a
// corner on a grid over the scene, rounded outwards by more than the tests below can be wrong (WideNode in structs.glsl).
#include "intersect.glsl"

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

// Where buffers are fetched as images, which is llvmpipe, the stacks of a work group are in its shared memory, one after
// the other: frames with next event estimation take a tenth less, with a table too a seventh. As a private array, the
// time of a kernel changes by up to a half with the array's size and the code around it. On GPUs it would cost occupancy.
#if FETCH == FETCH_IMAGE
shared uint stacks[BVH_DEPTH * TRACE_GROUP];
#define STACK(i) stacks[gl_LocalInvocationIndex * BVH_DEPTH + (i)]
#else
#define STACK(i) stack[i]
#endif

// Bodies stand in an `if`, here and in every loop whose lanes end at different turns: llvmpipe (Mesa 22.3) computes
// a value that leaves a loop again in the later turns of other lanes, unless a branch guards it.
void traverse(vec3 origin, vec3 direction, bool any_hit, inout Hit hit) {
  GridRay ray = grid_ray(origin, direction);
  Shear shear = shear_of(direction);
#if FETCH != FETCH_IMAGE
  uint stack[BVH_DEPTH];
#endif
  STACK(0u) = END_OF_WALK;
  uint top = 0u;  // of the stack: where the next link is taken from
  uint link = 0u;
  bool searching = true;
  do {
    bool descending = !is_leaf(link);
    do {
      if (descending) {
        uvec4 a = fetch(nodes, 2u * link);
        uvec4 b = fetch(nodes, 2u * link + 1u);
        int first = enter_box(ray, a.xyz, floatBitsToInt(hit.t));
        int second = enter_box(ray, uvec3(a.w, b.xy), floatBitsToInt(hit.t));
        bool swap = second < first;
        uint nearer = swap ? b.w : b.z;
        uint farther = swap ? b.z : b.w;
        uint popped = STACK(top);
        bool any = min(first, second) != NO_CHILD;
        bool both = max(first, second) != NO_CHILD;
        STACK(top + 1u) = farther;
        top = both ? top + 1u : any ? top : top - 1u;
        link = any ? nearer : popped;
        descending = !is_leaf(link);
      }
    } while (descending);
    loop_was_cut = loop_was_cut || !is_leaf(link);
    bool more = link != END_OF_WALK;
    uint triangle = (link & ~LEAF_LINK) >> LEAF_BITS;
    uint end = triangle + (link & ((1u << LEAF_BITS) - 1u));
    do {
      if (more) {
        test_triangle(origin, shear, triangle, hit);
        ++triangle;
        more = triangle < end;
      }
    } while (more);
    loop_was_cut = loop_was_cut || more;
    bool done = link == END_OF_WALK || (any_hit && hit.triangle != NO_TRIANGLE);
    if (!done) {
      link = STACK(top);
      --top;
    }
    searching = !done && link != END_OF_WALK;
  } while (searching);
  loop_was_cut = loop_was_cut || searching;
}
