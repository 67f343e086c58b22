// Russian roulette. By the path's throughput it undoes what a table is for: a direction that is drawn often because much
// comes from there makes each path count for less, and such paths are then ended.
#include "material/bsdf.glsl"
#include "path/bsdf_sample.glsl"
#include "path/path.glsl"
#include "sampling/direction.glsl"
#include "shared/math.glsl"
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if SAMPLER == SAMPLER_RL && ROULETTE == ROULETTE_VALUE
#include "learning/qtable.glsl"
#include "shared/fetch.glsl"
#endif

// At most, where reflectance is what it goes by: as in Goswami 2020, so that paths end also where nothing is absorbed.
const float MAX_SURVIVAL = 0.95;
// At least, where the table's values are: it bounds how far a survivor is scaled up. While the table is young it is nearly 1,
// since what a path was expected to bring means little then.
const float LEAST_SURVIVAL = 0.25;
const float YOUNG_FRAMES = 32.0;

// What the table expects of the path beyond this event, over what it did at the first one (adjoint-driven roulette: Vorba
// & Krivanek 2016). Negative where the table has no say. Before the event's own factor is in the throughput.
float survival_by_value(inout Path path, Event e, BsdfSample next, uint bounce) {
#if SAMPLER == SAMPLER_RL && ROULETTE == ROULETTE_VALUE
  if (e.cell.index == NO_CELL) return -1.0;
#ifdef HAS_OWN_LOBES
  // The table holds nothing of what the BSDF's own lobes lead to.
  if (next.direction.is_own) return -1.0;
  bool is_first = path.expected == 0.0;
#else
  bool is_first = bounce == 0u;
#endif
  float reflected = reflectance(e.surface, e.bsdf, e.wo) * fetch_one(next_values, e.cell.index);
  float value = average(path.throughput) * reflected;
  float least = max(LEAST_SURVIVAL, 1.0 - float(frame_number) / YOUNG_FRAMES);
  if (is_first) path.expected = value;
  return path.expected > 0.0 ? clamp(parameters.roulette_scale * value / path.expected, least, 1.0) : -1.0;
#else
  return -1.0;
#endif
}

float survival_by_reflectance(Path path) {
  return min(max_component(path.roulette), MAX_SURVIVAL);
}
