// A scattering event, as the path that reaches it sees it.
#include "geometry/intersect.glsl"
#include "geometry/surface.glsl"
#include "material/bsdf.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#ifdef HAS_TABLE
#include "learning/cell.glsl"
#endif

#ifdef HAS_LIGHT_PATHS
// What MIS needs to know of the other techniques that make a path: those that would have drawn it from its other end. Each
// of them has a density; over that of the part of the path that is there, as far as what is still to come does not count.
// These are the partial sums of Georgiev 2012 ("Implementing Vertex Connection and Merging", equations 31 to 40) for the
// power heuristic with exponent 2: roots of sums of squares, so that their range is that of densities.
struct PathSums {
  float chain;  // of techniques that draw the last event and the one before it from the other end (d_VC, not yet divided by
                // the cosine at the last event)
  float last;   // of those that draw the last event alone from there (d_VCM)
};
#endif

// Everything that the choice of a direction depends on.
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
#ifdef HAS_ABSORPTION
  vec3 medium;  // absorption on the viewer's side
#endif
#ifdef HAS_LIGHT_PATHS
  Hit hit;
  PathSums sums;
#endif
};

// Its directions are drawn by the BSDF alone then.
void leave_table_out(inout Event e) {
#ifdef HAS_TABLE
  e.cell = no_cell(e.surface);
#endif
#if SAMPLER == SAMPLER_RL
  e.is_guided = false;
  e.bsdf_share = 1.0;
#endif
}

int cell_of(Event e) {
#ifdef HAS_TABLE
  return e.cell.index;
#else
  return NO_CELL;
#endif
}
