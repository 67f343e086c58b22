// How a path goes on: the run's direction sampler and its density.
#include "geometry/surface.glsl"
#include "material/bsdf.glsl"
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

// A scattering event: everything that the choice of a direction depends on.
struct Event {
  Surface surface;
  Bsdf bsdf;
  vec3 wo;
#ifdef HAS_TABLE
  Cell cell;
#endif
#if SAMPLER == SAMPLER_RL
  bool is_guided;    // whether directions are drawn with the table
  float bsdf_share;  // of these, by the BSDF
#endif
};

int cell_of(Event e) {
#ifdef HAS_TABLE
  return e.cell.index;
#else
  return NO_CELL;
#endif
}

struct DirectionSample {
  vec3 direction;
  float pdf;   // of the whole mixture, per solid angle
  float bsdf;  // density of the BSDF's own sampler
  uint entry;  // of the Q-table, NO_ENTRY where there is none
  uint share;  // entry of the Q-table for the side of the mixture that drew it, NO_ENTRY where that is not learned
};

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

float direction_pdf(Event e, vec3 wi) {
  float bsdf = bsdf_pdf(e.surface, e.bsdf, e.wo, wi);
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
    drawn.direction = sample_bsdf(e.surface, e.bsdf, e.wo, u, u_lobe);
    drawn.bin = bin_of(to_cell(e.cell, e.surface.normal, drawn.direction));
  }
  return drawn;
#else
  vec2 square = by_table ? square_in_bin(chosen, u) : cosine_square(u);
  return Drawn(to_world(from_square(square), e.cell.tangent, e.surface.normal), by_table ? chosen : bin_at(square));
#endif
}

DirectionSample sample_direction(Event e, uvec4 bits) {
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
  result.bsdf = bsdf_pdf(e.surface, e.bsdf, e.wo, drawn.direction);
  result.pdf = mixture_pdf(e, result.bsdf, table);
  result.entry = e.is_guided ? first_bin(cell) + drawn.bin : NO_ENTRY;
  result.share = NO_ENTRY;
#ifdef LEARNS_MIXTURE
  if (e.is_guided) result.share = first_share(cell) + (by_table ? SHARE_TABLE : SHARE_BSDF);
#endif
  return result;
}

#elif SAMPLER == SAMPLER_UNIFORM

float direction_pdf(Event e, vec3 wi) {
  return dot(e.surface.normal, wi) > 0.0 ? 0.5 / PI : 0.0;
}

DirectionSample sample_direction(Event e, uvec4 bits) {
  float cosine = to_unit(bits.y);
  float sine = sqrt(max(0.0, 1.0 - cosine * cosine));
  float phi = 2.0 * PI * to_unit(bits.z);
  vec3 local = vec3(sine * cos(phi), sine * sin(phi), cosine);
  return DirectionSample(to_world(local, tangent_of(e.surface.normal), e.surface.normal), 0.5 / PI, 0.0, NO_ENTRY, NO_ENTRY);
}

#else

float direction_pdf(Event e, vec3 wi) {
  return bsdf_pdf(e.surface, e.bsdf, e.wo, wi);
}

DirectionSample sample_direction(Event e, uvec4 bits) {
  vec3 wi = sample_bsdf(e.surface, e.bsdf, e.wo, vec2(to_unit(bits.y), to_unit(bits.z)), to_unit(bits.w));
  return DirectionSample(wi, bsdf_pdf(e.surface, e.bsdf, e.wo, wi), 0.0, NO_ENTRY, NO_ENTRY);
}

#endif
