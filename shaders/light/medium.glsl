// Absorption in the volumes that surfaces bound (KHR_materials_volume).
#include "geometry/scene.glsl"
#include "geometry/surface.glsl"
#include "sampling/direction.glsl"
#include "shared/math.glsl"

#ifdef HAS_ABSORPTION

// The part that a way through a medium leaves: Beer and Lambert's law.
vec3 left_after(vec3 absorption, float t) {
  // Of a way without end, which what absorbs nothing leaves whole.
  if (t == INFINITY) return vec3(equal(absorption, vec3(0.0)));
  return exp(-absorption * t);
}

// Where a ray towards `direction` is on.
vec3 medium_towards(Event e, vec3 direction) {
  vec3 medium = e.medium;
  bool passes = dot(e.surface.geometric_normal, direction) < 0.0 && transmission_of(e.surface.material).y > 0.0;
  if (passes) medium = e.surface.back ? vec3(0.0) : absorption_of(e.surface.material).rgb;
  return medium;
}

#endif
