// How the partial sums of a path grow from event to event (PathSums in event.glsl).
#include "material/own_lobes.glsl"
#include "mis/seen_from.glsl"
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "shared/parameters.glsl"
#include "shared/variants.glsl"

// Of the techniques that draw the path up to this event from its other end, which leads on from there with this density
// per solid angle towards wo.
float drawn_from_behind(Event e, float reverse_pdf) {
  return length(vec2(e.sums.last, e.sums.chain * reverse_pdf / face_cosine(e, e.wo)));
}

// The same at an event of the camera's path, which light paths reach from `wi`: they lead on by the BSDF.
float drawn_by_light_paths(Event e, vec3 wi) {
  float reverse = 0.0;
  if (e.sums.chain > 0.0) reverse = bsdf_pdf(seen_from(e, wi), e.wo);
  return drawn_from_behind(e, reverse);
}

// Behind an event whose direction `wi` was drawn with the density `pdf`. Where events are not connected to one another, no
// technique draws the next one alone.
PathSums sums_behind(Event e, vec3 wi, float pdf, float from_behind) {
  float last = 0.0;
#ifdef HAS_CONNECTIONS
  last = parameters.connections / pdf;
#endif
  return PathSums(face_cosine(e, wi) / pdf * from_behind, last);
}

// Of these, upon arrival at an event: densities per solid angle of a direction from `origin` become those per area.
PathSums sums_on_arrival(PathSums sums, Event e, vec3 origin) {
  vec3 way = e.surface.position - origin;
  return PathSums(sums.chain, sums.last * dot(way, way) / face_cosine(e, e.wo));
}

#ifdef HAS_OWN_LOBES

// How a smooth lobe from wo to wi widens a beam: solid angle about wi over that about wo (by the indices of refraction and
// cosines, Snell), times the cosines that make densities per area of both.
float widening(Event e, vec3 wi) {
  float ratio = face_cosine(e, wi) / face_cosine(e, e.wo);
#ifdef HAS_TRANSMISSION
  if (dot(e.surface.geometric_normal, wi) < 0.0) {
    float index = e.bsdf.far_index;
    ratio *= abs(dot(e.surface.normal, e.wo)) / (index * index * max(abs(dot(e.surface.normal, wi)), 1e-6));
  }
#endif
  return ratio;
}

// Behind one that led on by a smooth lobe, which nothing can connect to.
PathSums sums_behind_smooth(Event e, vec3 wi, float probability, float reverse_probability) {
  float ratio = probability > 0.0 ? reverse_probability / probability : 0.0;
  return PathSums(e.sums.chain * ratio * widening(e, wi), 0.0);
}

#endif
