// The rule monte_carlo: the path keeps its vertices and, when it has ended, gives each of them the return: what it found
// beyond. As if it had started there: emission met by the direction that was drawn counts in full, later emission
// with the weight that NEE leaves to it.
#include "learning/gather.glsl"
#include "path/bsdf_sample.glsl"
#include "path/path.glsl"
#include "sampling/direction.glsl"
#include "sampling/path_bits.glsl"
#include "shared/loops.glsl"
#include "shared/math.glsl"
#include "shared/variants.glsl"

const bool BOOTSTRAPS_AT_LAST_HIT = false;

struct PathVertex {
  uint entry;      // of the direction that was drawn here
  vec3 direct;     // direct light by NEE, reflected here
  vec3 weight;     // of what comes from that direction
  vec3 emission;   // met by the ray in that direction
  float share;     // of that emission in the path's own sum
};

PathVertex vertices[MAX_VERTICES];
uint events = 0u;    // vertices with `direct`
uint arrivals = 0u;  // of these, those whose ray has met something or left the scene

void record_arrival(uint bounce, vec3 emission, float share) {
  if (bounce == 0u) return;
  vertices[bounce - 1u].emission = emission;
  vertices[bounce - 1u].share = share;
  arrivals = bounce;
}

// Of radiance, what the way of the path's last ray leaves. What the ray found carries it with it, and so does the event
// that it led to.
vec3 reaching(Path path) {
#ifdef HAS_ABSORPTION
  return path.reaching;
#else
  return vec3(1.0);
#endif
}

void record_miss(inout Path path, uint bounce, vec3 radiance, float weight) {
  record_arrival(bounce, radiance * reaching(path), weight);
}

void record_hit(inout Path path, Event e, BsdfSample next, uint bounce, vec3 emitted, float weight, bool scatters,
                EventBits bits) {
  record_arrival(bounce, emitted * reaching(path), weight);
}

void record_scattering(inout Path path, uint bounce, vec3 direct, BsdfSample next) {
  vertices[bounce].entry = next.direction.entry;
  vertices[bounce].direct = direct * reaching(path);
  vertices[bounce].weight = next.weight * reaching(path);
  events = bounce + 1u;
}

void record_survival(uint bounce, float survival) {
  vertices[bounce].weight /= survival;
}

void update_after_ray(inout Path path, PreviousAction previous) {}

// Backwards along the path: `beyond` is the radiance that leaves an event towards the one before, without the
// event's own emission.
void update_after_path(inout Path path) {
  vec3 beyond = events > arrivals ? vertices[arrivals].direct : vec3(0.0);
  uint left = arrivals;
  bool more = left > 0u;
  do {
    if (more) {
      --left;
      PathVertex vertex = vertices[left];
      vec3 met = vertex.emission * (LEARNS == LEARNS_BEYOND_NEE ? vertex.share : 1.0);
      gather_radiance(path.tally, vertex.entry, average(met + beyond));
      beyond = vertex.direct + vertex.weight * (vertex.share * vertex.emission + beyond);
      more = left > 0u;
    }
  } while (more);
  loop_was_cut = loop_was_cut || left > 0u;
}
