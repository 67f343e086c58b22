// Traversal with a stack, the nearer child first, as it is fastest where a SIMD register's lanes read and write memory
// one by one: on llvmpipe.
#include "geometry/intersect.glsl"
#include "geometry/wide_nodes.glsl"
#include "shared/loops.glsl"
#include "shared/structs.glsl"

// The stack of links yet to follow: the eight on top in registers, EMPTY where there are fewer, and the older ones in
// memory. Nodes are walked with those in registers alone: there, a stack in memory alone takes a quarter of a frame's
// time.
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

// Shared memory is cheaper there than a private array.
shared uint stored_links[BVH_DEPTH * TRACE_GROUP];
#define STORED(i) stored_links[gl_LocalInvocationIndex * BVH_DEPTH + (i)]

// Bodies stand in an `if` (shaders/README.md).
void traverse(vec3 origin, vec3 direction, bool any_hit, inout Hit hit) {
  GridRay ray = grid_ray(origin, direction);
  Shear shear = shear_of(direction);
  Stack stack = stack_of(END_OF_WALK);
  uint link = 0u;
  bool searching = true;
  do {
    bool descending = !is_leaf(link);
    do {
      if (descending) {
        Descent next = descend(ray, link, hit.t);
        link = next.any ? next.nearer : stack.top.x;
        push_or_pop(stack, next.both, next.farther, !next.any);
        descending = !is_leaf(link) && !is_full(stack);
      }
    } while (descending);
    loop_was_cut = loop_was_cut || descending;
    bool at_leaf = is_leaf(link);
    uint triangle = first_triangle(link);
    uint end = triangle + triangles_of(link);
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
