// An event of the camera's path joined to one of a light path of the same frame: one is chosen of those whose path through both
// is not too long. Weighted as an expected number of such choices, whatever their number is for this light path: the weights
// of all techniques sum to one then, and the estimate has the true number. That neighbouring pixels may choose the same light
// path ties them together, which costs variance that the weights do not know of (Grittmann et al. 2021, "Correlation-Aware
// Multiple Importance Sampling for Bidirectional Rendering Algorithms").
#include "connection/camera_side.glsl"
#include "connection/light_vertices.glsl"
#include "geometry/intersect.glsl"
#include "geometry/surface.glsl"
#include "light/medium.glsl"
#include "light/nee.glsl"
#include "light/shadow.glsl"
#include "material/own_lobes.glsl"
#include "mis/path_sums.glsl"
#include "mis/seen_from.glsl"
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "sampling/random.glsl"
#include "shared/counters.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"

#ifdef HAS_CONNECTIONS

layout(std430, binding = BINDING_LIGHT_PATHS) restrict readonly buffer LightPathBuffer { uvec4 light_path_counts[]; };

struct ChosenVertex {
  uint index;
  uint choices;  // that there were, all alike; 0 where there is none
};

// With `events` of the camera.
ChosenVertex choose_vertex(uvec2 words, uint events) {
  uint path, rest;
  umulExtended(words.x, parameters.kept_paths, path, rest);
  uint kept = light_path_counts[path].y >> 16u;
  ChosenVertex chosen;
  chosen.choices = min(kept, parameters.max_bounces - events);
  uint place;
  umulExtended(words.y, chosen.choices, place, rest);
  chosen.index = vertex_place(path, place);
  return chosen;
}

// The event as the light path sees it.
Event event_of(LightVertex vertex) {
  Event e;
  e.hit = Hit(0.0, vertex.triangle, vec2(vertex.second, vertex.third));
  e.surface = surface_at(e.hit, -vertex.wo);
  e.wo = vertex.wo;
  e.bsdf = bsdf_of(e.surface, e.wo);
  e.sums = PathSums(vertex.chain, vertex.last);
  leave_table_out(e);
#ifdef HAS_ABSORPTION
  e.medium = vec3(0.0);
#endif
  return e;
}

// Of the connection from e along `direction` to z over a distance, among all techniques that make its path. `seen`: z from e.
float connection_weight(Event e, Event z, Event seen, uint light, vec3 direction, float distance) {
  float per_area = 1.0 / (distance * distance * parameters.connections);
  float by_light = bsdf_pdf(z, -direction) * face_cosine(e, direction) * per_area;
  float by_camera = direction_pdf(e, direction) * face_cosine(z, direction) * per_area;
  return weight_beside(by_light * drawn_by_light_paths(e, direction), by_camera * drawn_by_camera(z, seen, light));
}

// The part of what leaves z that arrives at e.
vec3 left_between(Event e, Event z, LightVertex vertex, vec3 direction, float distance, inout Tally tally) {
  vec3 origin = ray_origin(z.surface, -direction);
  vec3 left = vec3(transmittance(origin, ray_origin(e.surface, direction) - origin, tally.rays));
#ifdef HAS_ABSORPTION
  left *= left_after(medium_towards(e, direction), distance + vertex.way);
#endif
  return left;
}

// What reaches e, `events` in number from the camera on, is sent on along the camera's path.
vec3 connected_light(Event e, uint events, RandomKey key, inout Tally tally) {
  if (events >= parameters.max_bounces) return vec3(0.0);
  ChosenVertex chosen = choose_vertex(random_bits(key, BLOCKS_OF_CONNECTIONS + events).xy, events);
  if (chosen.choices == 0u) return vec3(0.0);
  LightVertex vertex = light_vertices[chosen.index];
  if (vertex.events + events > parameters.max_bounces) return vec3(0.0);
  Event z = event_of(vertex);
  vec3 way = z.surface.position - e.surface.position;
  float distance = length(way);
  vec3 direction = way / distance;
  if (distance == 0.0) return vec3(0.0);
  Event seen = seen_by_camera(z, -direction, tally);
  vec3 scattered = bsdf_cosine(e.surface, e.bsdf, e.wo, direction) *
                   bsdf_cosine(seen.surface, seen.bsdf, seen.wo, z.wo) * vertex.flux;
  if (scattered == vec3(0.0)) return scattered;
  ++tally.connections;
  float geometry = face_cosine(z, direction) / (distance * distance * face_cosine(z, z.wo));
  float weight = connection_weight(e, z, seen, vertex.light, direction, distance);
  return scattered * left_between(e, z, vertex, direction, distance, tally) *
         (geometry * weight * float(chosen.choices));
}

#endif
