// What a ray meets where surfaces may let it pass. Passing is no scattering event: the ray goes on as it was.
#include "geometry/intersect.glsl"
#include "geometry/surface.glsl"
#include "geometry/traverse.glsl"
#include "material/opacity.glsl"
#include "sampling/random.glsl"
#include "shared/loops.glsl"
#include "shared/structs.glsl"

struct Meeting {
  Hit hit;         // t: from where the ray began, in units of its length
  uint passed;     // surfaces
#ifdef HAS_ALPHA
  Surface surface;
#endif
};

Meeting meeting(vec3 origin, vec3 direction, bool by_chance, uint word) {
  Meeting m;
  m.passed = 0u;
#ifdef HAS_ALPHA
  vec3 start = origin;
  bool passing = true;
  do {
    if (passing) {
      m.hit = closest_hit(start, direction);
      passing = false;
      if (m.hit.triangle != NO_TRIANGLE) {
        m.surface = surface_at(m.hit, direction);
        m.hit.t = dot(m.surface.position - origin, direction);
        float needed = by_chance ? 1.0 - to_unit(pcg4d(uvec4(word, m.passed, 0u, 0u)).x) : 0.5;
        passing = opacity_of(m.surface) < needed;
        if (passing) {
          start = ray_origin(m.surface, direction);
          ++m.passed;
        }
      }
    }
  } while (passing);
  loop_was_cut = loop_was_cut || passing;
#else
  m.hit = closest_hit(origin, direction);
#endif
  return m;
}

// `direction`: unit. A surface is met with the chance of its opacity; `word` is random.
Meeting meet(vec3 origin, vec3 direction, uint word) {
  return meeting(origin, direction, true, word);
}

// What a picture of the surfaces shows there: those with an opacity of a half or more.
Meeting meet_half_opaque(vec3 origin, vec3 direction) {
  return meeting(origin, direction, false, 0u);
}

// Of a meeting that hit something.
Surface met_surface(Meeting m, vec3 direction) {
#ifdef HAS_ALPHA
  return m.surface;
#else
  return surface_at(m.hit, direction);
#endif
}
