// How much of a light's radiance reaches a surface.
#include "geometry/intersect.glsl"
#include "geometry/surface.glsl"
#include "geometry/traverse.glsl"
#include "material/opacity.glsl"
#include "shared/loops.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#ifdef HAS_ALPHA

// The part that passes all surfaces at t in (0, 1) of the segment; `rays` are counted.
float transmittance(vec3 origin, vec3 segment, inout uint rays) {
  vec3 end = origin + segment;
  vec3 direction = normalize(segment);
  vec3 start = origin;
  float left = 1.0;
  bool passing = true;
  do {
    if (passing) {
      ++rays;
      Hit hit = nearest_hit(start, end - start, 1.0);
      passing = false;
      if (hit.triangle != NO_TRIANGLE) {
        Surface s = surface_at(hit, direction);
        left *= 1.0 - opacity_of(s);
        start = ray_origin(s, direction);
        passing = left > 0.0 && dot(end - start, direction) > 0.0;
      }
    }
  } while (passing);
  loop_was_cut = loop_was_cut || passing;
  return left;
}

#else

float transmittance(vec3 origin, vec3 segment, inout uint rays) {
  ++rays;
#if NEE == NEE_TWO_RAY
  // Goswami 2020 asks by a closest hit.
  return closest_hit(origin, segment).t >= 1.0 ? 1.0 : 0.0;
#else
  return is_occluded(origin, segment) ? 0.0 : 1.0;
#endif
}

#endif
