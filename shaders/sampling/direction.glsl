// How a path goes on: the run's direction sampler and its density. The BSDF's own lobes (own_lobes.glsl) come first, each with
// its share; the run's sampler has the rest, the hemisphere.
#include "geometry/surface.glsl"
#include "material/bsdf.glsl"
#include "material/own_lobes.glsl"
#include "sampling/event.glsl"
#include "sampling/random.glsl"
#include "shared/fetch.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#ifdef HAS_TABLE
#include "learning/cell.glsl"
#endif
#if SAMPLER == SAMPLER_RL
#include "learning/bins.glsl"
#include "learning/qtable.glsl"
#include "learning/table.glsl"
#endif

struct DirectionSample {
  vec3 direction;
  float pdf;   // of the whole mixture, per solid angle
  float bsdf;  // density of the BSDF's own sampler
  uint entry;  // of the Q-table, NO_ENTRY where there is none
  uint share;  // entry of the Q-table for the side of the mixture that drew it, NO_ENTRY where that is not learned
#ifdef HAS_OWN_LOBES
  bool is_own;    // drawn by one of the BSDF's own lobes
  bool is_delta;  // by a smooth one: pdf is infinite
  vec3 weight;    // of that lobe alone: f |cos(theta)| over its density
  float compression;  // of radiance (OwnSample)
#endif
};

// By a sampler that has nothing to learn.
DirectionSample untaught(vec3 direction, float pdf) {
  DirectionSample result;
  result.direction = direction;
  result.pdf = pdf;
  result.bsdf = 0.0;
  result.entry = NO_ENTRY;
  result.share = NO_ENTRY;
  return result;
}

#if SAMPLER == SAMPLER_RL

// One-sample MIS: p = c p_bsdf + (1 - c) p_Q; p_bsdf alone where no table guides.
float mixture_pdf(Event e, float bsdf, float table) {
  return e.is_guided ? mix(table, bsdf, e.bsdf_share) : bsdf;
}

float bsdf_share_of(Event e) {
#ifdef LEARNS_MIXTURE
  float share = e.cell.index == NO_CELL ? 1.0 : fetch_one(bsdf_shares, e.cell.index);
#ifdef HAS_SPECULAR
  // A specular lobe depends on where it is seen from and is narrower than bins are: what the BSDF leaves to it stays
  // its own.
  if (!is_lambert(e.bsdf)) share = mix(share, 1.0, specular_share(e.bsdf, dot(e.surface.normal, e.wo)));
#endif
  return share;
#else
  return parameters.bsdf_fraction;
#endif
}

float hemisphere_pdf(Event e, vec3 wi) {
  float bsdf = table_lobes_pdf(e.surface, e.bsdf, e.wo, wi);
  if (!e.is_guided) return bsdf;
  vec3 local = to_cell(e.cell, e.surface.normal, wi);
  if (local.z <= 0.0) return bsdf;  // below the surface the table has no bins
  return mixture_pdf(e, bsdf, table_pdf(uint(e.cell.index), bin_of(local)));
}

struct Drawn {
  vec3 direction;
  uint bin;
};

// By the table from the bin `chosen`, or by the BSDF; as much as can be is done once for both (shaders/README.md).
Drawn draw(Event e, bool by_table, uint chosen, vec2 u, float u_lobe) {
#ifdef HAS_SPECULAR
  Drawn drawn = Drawn(to_world(direction_in_bin(chosen, u), e.cell.tangent, e.surface.normal), chosen);
  if (!by_table) {
    drawn.direction = sample_table_lobes(e.surface, e.bsdf, e.wo, u, u_lobe);
    drawn.bin = bin_of(to_cell(e.cell, e.surface.normal, drawn.direction));
  }
  return drawn;
#else
  vec2 square = by_table ? square_in_bin(chosen, u) : cosine_square(u);
  return Drawn(to_world(from_square(square), e.cell.tangent, e.surface.normal), by_table ? chosen : bin_at(square));
#endif
}

DirectionSample sample_hemisphere(Event e, uvec4 bits) {
  uint cell = e.is_guided ? uint(e.cell.index) : 0u;
  Choice choice = choose_bin(cell, bits.w);
  bool by_table = e.is_guided && to_unit(bits.x) >= e.bsdf_share;
  Drawn drawn = draw(e, by_table, choice.action, vec2(to_unit(bits.y), to_unit(bits.z)), to_unit(bits.w));
  float table = bin_pdf(choice.probability);
#ifdef MIXES_BSDF
  if (!by_table) table = table_pdf(cell, drawn.bin);
#endif
  DirectionSample result;
  result.direction = drawn.direction;
  result.bsdf = table_lobes_pdf(e.surface, e.bsdf, e.wo, drawn.direction);
  result.pdf = mixture_pdf(e, result.bsdf, table);
  result.entry = e.is_guided ? first_bin(cell) + drawn.bin : NO_ENTRY;
  result.share = NO_ENTRY;
#ifdef LEARNS_MIXTURE
  if (e.is_guided) result.share = first_share(cell) + (by_table ? SHARE_TABLE : SHARE_BSDF);
#endif
  return result;
}

#elif SAMPLER == SAMPLER_UNIFORM

float hemisphere_pdf(Event e, vec3 wi) {
  return dot(e.surface.normal, wi) > 0.0 ? 0.5 / PI : 0.0;
}

DirectionSample sample_hemisphere(Event e, uvec4 bits) {
  float cosine = to_unit(bits.y);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  float phi = 2.0 * PI * to_unit(bits.z);
  vec3 local = vec3(sine * cos(phi), sine * sin(phi), cosine);
  return untaught(to_world(local, tangent_of(e.surface.normal), e.surface.normal), 0.5 / PI);
}

#else

float hemisphere_pdf(Event e, vec3 wi) {
  return table_lobes_pdf(e.surface, e.bsdf, e.wo, wi);
}

DirectionSample sample_hemisphere(Event e, uvec4 bits) {
  vec3 wi = sample_table_lobes(e.surface, e.bsdf, e.wo, vec2(to_unit(bits.y), to_unit(bits.z)), to_unit(bits.w));
  return untaught(wi, table_lobes_pdf(e.surface, e.bsdf, e.wo, wi));
}

#endif

#ifdef HAS_OWN_LOBES

struct OwnDraw {
  bool is_own;
  OwnSample sampled;
  float share;  // of all own lobes
  uint rest;    // a random word for what chooses next
};

// `bits`: the choice, direction, direction, unused.
OwnDraw draw_own_lobe(Event e, uvec4 bits) {
  OwnShares shares = own_shares(e.surface, e.bsdf, e.wo);
  float u = to_unit(bits.x);
  OwnDraw own;
  own.share = sum_of(shares);
  own.is_own = u < own.share;
  own.sampled = sample_own_lobes(e.surface, e.bsdf, e.wo, vec2(to_unit(bits.y), to_unit(bits.z)), u, shares);
  float rest = clamp((u - own.share) / max(1.0 - own.share, 1e-7), 0.0, 1.0);
  own.rest = uint(rest * 4294967040.0);
  return own;
}

// Density of all that may draw `wi`, where the hemisphere's sampler has `hemisphere`.
float with_own_lobes(Event e, float share, float hemisphere, vec3 wi) {
  return (1.0 - share) * hemisphere + own_lobes_pdf(e.surface, e.bsdf, e.wo, wi);
}

float direction_pdf(Event e, vec3 wi) {
  return with_own_lobes(e, sum_of(own_shares(e.surface, e.bsdf, e.wo)), hemisphere_pdf(e, wi), wi);
}

DirectionSample sample_direction(Event e, uvec4 bits) {
  OwnDraw own = draw_own_lobe(e, bits);
  DirectionSample result = sample_hemisphere(e, uvec4(own.rest, bits.yzw));
  result.is_own = own.is_own;
  // Rough lobes may draw below the surface, where their density is none and what passes has one.
  bool is_outside = !own.is_own && dot(e.surface.normal, result.direction) <= 0.0;
  result.is_delta = is_outside || (own.is_own && own.sampled.is_delta);
  result.weight = is_outside ? vec3(0.0) : own.sampled.weight;
  result.compression = own.is_own ? own.sampled.compression : 1.0;
  if (own.is_own) {
    result.direction = own.sampled.direction;
    result.pdf = hemisphere_pdf(e, result.direction);
    result.bsdf = table_lobes_pdf(e.surface, e.bsdf, e.wo, result.direction);
    result.entry = NO_ENTRY;
    result.share = NO_ENTRY;
  }
  result.pdf = with_own_lobes(e, own.share, result.pdf, result.direction);
  result.bsdf = with_own_lobes(e, own.share, result.bsdf, result.direction);
  if (result.is_delta) result.pdf = INFINITY;
  return result;
}

#else

float direction_pdf(Event e, vec3 wi) {
  return hemisphere_pdf(e, wi);
}

DirectionSample sample_direction(Event e, uvec4 bits) {
  return sample_hemisphere(e, bits);
}

#endif

// By the BSDF alone, whatever the run's sampler is.
float bsdf_pdf(Event e, vec3 wi) {
  float pdf = table_lobes_pdf(e.surface, e.bsdf, e.wo, wi);
#ifdef HAS_OWN_LOBES
  pdf = with_own_lobes(e, sum_of(own_shares(e.surface, e.bsdf, e.wo)), pdf, wi);
#endif
  return pdf;
}

struct BsdfDraw {
  vec3 direction;
  float pdf;    // infinite for a smooth lobe
  vec3 weight;  // f |cos(theta)| over the density
  bool is_lost;  // no density tells of it
};

BsdfDraw draw_bsdf(Event e, uvec4 bits) {
  vec4 u = to_units(bits);
  BsdfDraw drawn;
  drawn.direction = sample_table_lobes(e.surface, e.bsdf, e.wo, u.yz, u.w);
#ifdef HAS_OWN_LOBES
  OwnDraw own = draw_own_lobe(e, bits);
  if (own.is_own) drawn.direction = own.sampled.direction;
#endif
  drawn.pdf = bsdf_pdf(e, drawn.direction);
  drawn.weight = bsdf_cosine(e.surface, e.bsdf, e.wo, drawn.direction) / drawn.pdf;
  drawn.is_lost = false;
#ifdef HAS_OWN_LOBES
  if (own.is_own && own.sampled.is_delta) {
    drawn.pdf = INFINITY;
    drawn.weight = own.sampled.weight;
  }
  bool is_outside = !own.is_own && dot(e.surface.normal, drawn.direction) <= 0.0;
  if (is_outside) drawn.weight = vec3(0.0);
  drawn.is_lost = is_outside || (own.is_own && own.sampled.is_delta && own.sampled.weight == vec3(0.0));
#endif
  return drawn;
}
