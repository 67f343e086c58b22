// How a path goes on: the run's direction sampler and its density.
#include "bsdf.glsl"
#include "lights.glsl"
#if SAMPLER == SAMPLER_RL
#include "qtable.glsl"
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

float bsdf_share_of(Cell cell) {
#ifdef LEARNS_MIXTURE
  return cell.index == NO_CELL ? 1.0 : fetch_one(bsdf_shares, cell.index);
#else
  return parameters.rl.x;
#endif
}

float direction_pdf(Event e, vec3 wi) {
  float bsdf = bsdf_pdf(e.surface, e.bsdf, e.wo, wi);
  if (!e.is_guided) return bsdf;
  vec3 local = to_cell(e.cell, e.surface.normal, wi);
  if (local.z <= 0.0) return bsdf;  // below the surface the table has no bins
  return mixture_pdf(e, bsdf, table_pdf(uint(e.cell.index), bin_of(local)));
}

DirectionSample sample_direction(Event e, uvec4 bits) {
  vec2 u = vec2(to_unit(bits.y), to_unit(bits.z));
  DirectionSample result;
  if (!e.is_guided) {
    result.direction = sample_bsdf(e.surface, e.bsdf, e.wo, u, to_unit(bits.w));
    result.bsdf = result.pdf = bsdf_pdf(e.surface, e.bsdf, e.wo, result.direction);
    result.entry = result.share = NO_ENTRY;
    return result;
  }
  uint cell = uint(e.cell.index);
  Choice choice = choose_bin(cell, bits.w);
  uint bin = choice.column;
  float table = bin_pdf(choice.probability);
  bool by_table = to_unit(bits.x) >= e.bsdf_share;
  if (by_table) {
    result.direction = to_world(direction_in_bin(bin, u), e.cell.tangent, e.surface.normal);
  } else {
    result.direction = sample_bsdf(e.surface, e.bsdf, e.wo, u, to_unit(bits.w));
#ifdef MIXES_BSDF
    bin = bin_of(to_cell(e.cell, e.surface.normal, result.direction));
    table = table_pdf(cell, bin);
#endif
  }
  result.bsdf = bsdf_pdf(e.surface, e.bsdf, e.wo, result.direction);
  result.pdf = mixture_pdf(e, result.bsdf, table);
  result.entry = first_bin(cell) + bin;
  result.share = NO_ENTRY;
#ifdef LEARNS_MIXTURE
  result.share = first_share(cell) + (by_table ? SHARE_TABLE : SHARE_BSDF);
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
