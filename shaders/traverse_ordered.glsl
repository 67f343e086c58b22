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

// The stack of links yet to follow: the eight on top in registers, EMPTY where there are fewer, and the older ones in
// memory. Nodes are walked with those in registers alone. llvmpipe reads and writes memory lane by lane: a stack in
// memory alone takes a quarter of a frame's time.
struct Stack {
  uvec4 top;
  uvec4 rest;
  uint stored;  // in memory
};

// A leaf without triangles.
const uint EMPTY = LEAF_LINK;

Stack stack_of(uint link) {
  return Stack(uvec4(link, uvec3(EMPTY)), uvec4(EMPTY), 0u);
}

bool is_full(Stack stack) {
  return stack.rest.w != EMPTY;
}

// Of a stack that is not full.
void push_or_pop(inout Stack stack, bool push, uint link, bool pop) {
  uvec4 top = stack.top;
  uvec4 rest = stack.rest;
  stack.top = push ? uvec4(link, top.xyz) : pop ? uvec4(top.yzw, rest.x) : top;
  stack.rest = push ? uvec4(top.w, rest.xyz) : pop ? uvec4(rest.yzw, EMPTY) : rest;
}

// On llvmpipe in shared memory, which is cheaper there than a private array; elsewhere it would cost occupancy.
#if FETCH == FETCH_IMAGE
shared uint stored_links[BVH_DEPTH * TRACE_GROUP];
#define STORED_LINKS
#define STORED(i) stored_links[gl_LocalInvocationIndex * BVH_DEPTH + (i)]
#else
#define STORED_LINKS uint stored_links[BVH_DEPTH];
#define STORED(i) stored_links[i]
#endif

// Bodies stand in an `if`, here and in every loop whose lanes end at different turns: llvmpipe (Mesa 22.3) computes
// a value that leaves a loop again in the later turns of other lanes, unless a branch guards it.
void traverse(vec3 origin, vec3 direction, bool any_hit, inout Hit hit) {
  GridRay ray = grid_ray(origin, direction);
  Shear shear = shear_of(direction);
  STORED_LINKS
  Stack stack = stack_of(END_OF_WALK);
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
        bool any = min(first, second) != NO_CHILD;
        bool both = max(first, second) != NO_CHILD;
        link = any ? nearer : stack.top.x;
        push_or_pop(stack, both, farther, !any);
        descending = !is_leaf(link) && !is_full(stack);
      }
    } while (descending);
    loop_was_cut = loop_was_cut || descending;
    bool at_leaf = is_leaf(link);
    uint triangle = (link & ~LEAF_LINK) >> LEAF_BITS;
    uint end = triangle + (link & ((1u << LEAF_BITS) - 1u));
    bool more = at_leaf && link != END_OF_WALK && link != EMPTY;
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
      if (is_full(stack)) {
        STORED(stack.stored) = stack.rest.w;
        STORED(stack.stored + 1u) = stack.rest.z;
        stack.stored += 2u;
        stack.rest.zw = uvec2(EMPTY);
      }
      if (at_leaf) {
        link = stack.top.x;
        push_or_pop(stack, false, EMPTY, true);
        if (link == EMPTY) link = STORED(--stack.stored);
      }
    }
    searching = !done && link != END_OF_WALK;
  } while (searching);
  loop_was_cut = loop_was_cut || searching;
}
