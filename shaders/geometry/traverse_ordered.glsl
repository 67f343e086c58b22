// Traversal with a stack in memory, the nearer child first: GPUs.
#include "geometry/intersect.glsl"
#include "geometry/wide_nodes.glsl"
#include "shared/loops.glsl"
#include "shared/structs.glsl"

// One for all queries of a shader: NVIDIA's driver (580.159) keeps an array of its own for each place where a function
// is inlined, and fewer invocations at a time the more memory each has.
uint waiting_links[BVH_DEPTH];

void traverse(vec3 origin, vec3 direction, bool any_hit, inout Hit hit) {
  GridRay ray = grid_ray(origin, direction);
  Shear shear = shear_of(direction);
  waiting_links[0] = END_OF_WALK;
  uint waiting = 1u;
  uint link = 0u;
  while (link != END_OF_WALK) {
    while (!is_leaf(link)) {
      Descent next = descend(ray, link, hit.t);
      if (next.both) waiting_links[waiting++] = next.farther;
      link = next.any ? next.nearer : waiting_links[--waiting];
    }
    loop_was_cut = loop_was_cut || !is_leaf(link);
    if (link == END_OF_WALK) break;
    uint triangle = first_triangle(link);
    uint end = triangle + triangles_of(link);
    for (; triangle < end; ++triangle) test_triangle(origin, shear, triangle, hit);
    loop_was_cut = loop_was_cut || triangle < end;
    link = any_hit && hit.triangle != NO_TRIANGLE ? END_OF_WALK : waiting_links[--waiting];
  }
  loop_was_cut = loop_was_cut || link != END_OF_WALK;
}
