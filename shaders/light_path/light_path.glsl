// A path from a light: at most max_bounces scattering events, each of which is connected to the camera. What it brings to a
// pixel is the radiance that a path of the camera through the same points would find, weighted against those techniques of the
// camera that find it, too. Formulas are written for the path as the camera sees it: f |cos| is that of the camera's side,
// where shading normals and indices of refraction stand as they do there, and the cosines between both sides are those of the
// triangles. That is Veach's adjoint of shading normals (1997, section 5.3) and of refraction (section 5.2).
#include "connection/camera_side.glsl"
#include "connection/light_vertices.glsl"
#include "geometry/camera.glsl"
#include "geometry/surface.glsl"
#include "light/lights.glsl"
#include "light/medium.glsl"
#include "light/nee.glsl"
#include "light/punctual.glsl"
#include "light/shadow.glsl"
#include "light_path/numbers.glsl"
#include "light_path/splat.glsl"
#include "light_path/start.glsl"
#include "material/own_lobes.glsl"
#include "mis/path_sums.glsl"
#include "mis/seen_from.glsl"
#include "path/roulette.glsl"
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "sampling/meeting.glsl"
#include "sampling/path_bits.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

struct LightPath {
  vec3 origin;
  vec3 direction;
  vec3 flux;      // what it carries, over the densities of all that was drawn
  vec3 roulette;  // what Russian roulette goes by
  PathSums sums;
  uint light;      // as in LightStart, up to the first event
  float arrivals;  // likewise
  bool is_far;
#ifdef HAS_ABSORPTION
  vec3 medium;       // absorption per length where the ray is, as far as that is known:
  bool left_volume;  // whether the path has met a surface that bounds a volume, from inside or outside,
  float way;         // and how long it is up to there
#endif
#ifdef HAS_CONNECTIONS
  vec3 left;  // position of the event that `origin` is at
  uint kept;  // of its events
#endif
  Tally tally;
  uint splats;
};

#ifdef HAS_CONNECTIONS
// `events`: of the path, this one included. A last one would make paths of the camera too long, and what is smooth cannot be
// connected.
void keep(inout LightPath path, Event e, uint index, uint events) {
  if (index >= parameters.kept_paths || events >= parameters.max_bounces) return;
#ifdef HAS_OWN_LOBES
  if (is_smooth(e.bsdf)) return;
#endif
  float way = 0.0;
#ifdef HAS_ABSORPTION
  if (!path.left_volume) way = path.way;
#endif
  light_vertices[vertex_place(index, path.kept)] =
      LightVertex(path.flux, e.sums.chain, e.wo, e.sums.last, e.hit.barycentric.x, e.hit.barycentric.y, e.hit.triangle,
                  path.light, events, way, uvec2(0u));
  ++path.kept;
}
#endif

// At the first event: the light's samples of the camera's side, for each unit of their probability, over the path.
float light_samples_over(LightPath path, Event e, float t) {
#if NEE == NEE_ONE_RAY
  if (path.light != NO_LIGHT) return (path.is_far ? 1.0 : t * t) / (path.arrivals * face_cosine(e, e.wo));
#endif
  return 0.0;
}

// The part of a connection that is not opaque; the ray starts at the camera, as camera rays do.
float reaching_camera(Event e, CameraView view, inout Tally tally) {
  Surface s = e.surface;
  s.offset = max(s.offset, OFFSET_FRACTION * view.distance);
  vec3 origin = s.position + view.distance * view.direction;
  return transmittance(origin, ray_origin(s, view.direction) - origin, tally.rays);
}

// `density`: that of the camera's rays at the event, per area, over the number of light paths.
float weight_at_camera(LightPath path, Event e, Event seen, float density) {
  return weight_beside(density * drawn_by_camera(e, seen, path.light), 0.0);
}

// The camera stands in air, and nothing on the way to it is passed: no volume absorbs there.
void connect_to_camera(inout LightPath path, Event e) {
  CameraView view = camera_view(e.surface.position);
  if (!view.is_in_image) return;
  Event seen = seen_by_camera(e, view.direction, path.tally);
  vec3 reflected = bsdf_cosine(seen.surface, seen.bsdf, view.direction, e.wo);
  float density = view.density * face_cosine(e, view.direction) / float(parameters.light_paths);
  vec3 brought = path.flux * reflected * (density / face_cosine(e, e.wo));
  if (brought == vec3(0.0)) return;
  float weight = weight_at_camera(path, e, seen, density);
  add_splat(view.pixel, brought * (weight * reaching_camera(e, view, path.tally)), path.tally);
  ++path.splats;
}

#ifdef HAS_OWN_LOBES
// Draws the next direction from a smooth lobe, or ends the path where the camera's side knows none that leads back.
vec3 pass_by_smooth_lobe(inout LightPath path, Event e, Event seen) {
  SmoothLobes drawn = smooth_lobes(e.surface, e.bsdf, e.wo, seen.wo);
  SmoothLobes back = smooth_lobes(seen.surface, seen.bsdf, seen.wo, e.wo);
  if (drawn.probability <= 0.0) return vec3(0.0);
  path.sums = sums_behind_smooth(e, seen.wo, drawn.probability, back.probability);
  return back.value * (widening(e, seen.wo) / drawn.probability);
}
#endif

// Behind an event: the factor of the flux, zero where the path ends.
vec3 pass_on(inout LightPath path, Event e, BsdfDraw drawn) {
  Event seen = seen_by_camera(e, drawn.direction, path.tally);
#ifdef HAS_OWN_LOBES
  if (drawn.pdf == INFINITY) return pass_by_smooth_lobe(path, e, seen);
#endif
  vec3 reflected = bsdf_cosine(seen.surface, seen.bsdf, seen.wo, e.wo);
  path.sums = sums_behind(e, drawn.direction, drawn.pdf, drawn_by_camera(e, seen, path.light));
  return reflected * (face_cosine(e, drawn.direction) / (face_cosine(e, e.wo) * drawn.pdf));
}

// Returns whether the path goes on.
bool scatter_light(inout LightPath path, Event e, EventBits bits, uint bounce) {
  BsdfDraw drawn = draw_bsdf(e, bits.direction);
  if (drawn.is_lost || drawn.pdf <= 0.0) return false;
  vec3 factor = pass_on(path, e, drawn);
  if (factor == vec3(0.0)) return false;
  path.flux *= factor;
  path.roulette *= factor;
  path.origin = ray_origin(e.surface, drawn.direction);
  path.direction = drawn.direction;
  path.light = NO_LIGHT;
#ifdef HAS_CONNECTIONS
  path.left = e.surface.position;
#endif
#ifdef HAS_ABSORPTION
  path.medium = medium_towards(e, path.direction);
#endif
  if (bounce + 1u > parameters.russian_roulette_start) {
    float survival = min(max_component(path.roulette), MAX_SURVIVAL);
    if (to_unit(bits.light.w) >= survival) return false;
    path.flux /= survival;
    path.roulette /= survival;
  }
  return true;
}

#ifdef HAS_ABSORPTION
// What a lamp stands in is not known before its light meets a surface that bounds a volume: where that is met from inside,
// all the way up to there was in it.
void absorb(inout LightPath path, Event e, float t) {
  path.flux *= left_after(path.medium, t);
  vec4 factors = transmission_of(e.surface.material);
  if (path.left_volume) return;
  path.way += t;
  if (factors.y <= 0.0) return;
  path.left_volume = true;
  if (e.surface.back) path.flux *= left_after(absorption_of(e.surface.material).rgb, path.way);
}
#endif

// The event that the ray has met, `t` along it.
Event light_event(inout LightPath path, Meeting met, uint bounce) {
  Event e;
  e.surface = met_surface(met, path.direction);
  e.wo = -path.direction;
  e.bsdf = bsdf_of(e.surface, e.wo);
  e.hit = met.hit;
  e.sums = path.sums;
  if (bounce == 0u) e.sums.last = light_samples_over(path, e, met.hit.t);
#ifdef HAS_CONNECTIONS
  if (bounce > 0u) e.sums = sums_on_arrival(path.sums, e, path.left);
#endif
  leave_table_out(e);
#ifdef HAS_ABSORPTION
  absorb(path, e, met.hit.t);
  e.medium = path.medium;
#endif
#ifdef HAS_PUNCTUAL
  if (path.light != NO_LIGHT) {
    float kind = light_choice(path.light).z;
    if (is_punctual(kind)) path.flux *= punctual_window(path.light, kind, met.hit.t);
  }
#endif
  return e;
}

LightPath light_path_from(LightStart start) {
  LightPath path;
  path.origin = start.origin;
  path.direction = start.direction;
  path.flux = start.flux;
  path.roulette = vec3(1.0);
  path.sums = PathSums(start.chain, 0.0);
  path.light = start.light;
  path.arrivals = start.arrivals;
  path.is_far = start.is_far;
#ifdef HAS_ABSORPTION
  path.medium = vec3(0.0);
  path.left_volume = start.is_far;
  path.way = 0.0;
#endif
#ifdef HAS_CONNECTIONS
  path.left = start.origin;
  path.kept = 0u;
#endif
  path.tally = Tally(0u, 0u, 0u, 0u, 0u, 0u, 0u);
  path.splats = 0u;
  return path;
}

LightPath trace_light_path(RandomKey key) {
  LightPath path = light_path_from(start_of(start_numbers(key.pixel, key.frame, key.seed)));
  uint bounce = 0u;
  bool going_on = path.flux != vec3(0.0);
  do {
    if (going_on) {
      ++path.tally.rays;
      Meeting met = meet(path.origin, path.direction, passing_word(key, BLOCKS_OF_LIGHT_PATHS + bounce));
      path.tally.rays += met.passed;
      going_on = met.hit.triangle != NO_TRIANGLE;
      if (going_on) {
        Event e = light_event(path, met, bounce);
        connect_to_camera(path, e);
#ifdef HAS_CONNECTIONS
        keep(path, e, key.pixel, bounce + 1u);
#endif
        going_on = bounce + 1u < parameters.max_bounces &&
                   scatter_light(path, e, light_event_bits(key, bounce), bounce);
      }
      ++bounce;
    }
  } while (going_on);
  loop_was_cut = loop_was_cut || going_on;
  return path;
}
