// Ray queries.
#include "geometry/intersect.glsl"
#include "shared/math.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#ifndef BVH
#define BVH BVH_SAH
#endif
// In the order of StackPlace (engine/gpu/driver.h).
#define STACK_MEMORY 0
#define STACK_REGISTERS 1
#if BVH == BVH_THREADED
#include "geometry/traverse_threaded.glsl"
#elif STACK == STACK_REGISTERS
#include "geometry/traverse_registers.glsl"
#else
#include "geometry/traverse_ordered.glsl"
#endif

// The nearest hit at t in (0, most); `direction` need not be unit.
Hit nearest_hit(vec3 origin, vec3 direction, float most) {
  Hit hit = Hit(most, NO_TRIANGLE, vec2(0.0));
  traverse(origin, direction, false, hit);
  return hit;
}

// At any distance.
Hit closest_hit(vec3 origin, vec3 direction) {
  return nearest_hit(origin, direction, INFINITY);
}

// Whether anything stands at t in (0, 1).
bool is_occluded(vec3 origin, vec3 direction) {
  Hit hit = Hit(1.0, NO_TRIANGLE, vec2(0.0));
  traverse(origin, direction, true, hit);
  return hit.triangle != NO_TRIANGLE;
}
