// Layout of the table: its states are the cells, and the actions of each are its direction bins, then the lights whose
// use is learned, and the two sides of the mixture of BSDF and table where that is. A direction's value is the expected
// incident radiance, averaged over the channels; a light's is the mean square of what it contributes when it is chosen,
// in units of the brightest light. A mixture's is the mean square of what its directions brought by the BSDF, and by
// the table.
#include "shared/parameters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#if SAMPLER == SAMPLER_RL
#include "learning/bins.glsl"
#else
const int BINS = 0;
#endif
#ifdef LEARNS_MIXTURE
const int MIXTURE_ACTIONS = 2;
#else
const int MIXTURE_ACTIONS = 0;
#endif
const uint TABLE_ACTIONS = uint(BINS + LIGHT_ACTIONS + MIXTURE_ACTIONS);

// Place of a cell's mark, behind the sums of all cells: not 0 where the frame has gathered a target for the cell.
uint mark_of(uint cell) {
  return parameters.cells * TABLE_ACTIONS * SUM_WORDS + cell;
}

uint first_bin(uint cell) {
  return cell * TABLE_ACTIONS;
}

uint first_light(uint cell) {
  return cell * TABLE_ACTIONS + uint(BINS);
}

uint first_share(uint cell) {
  return first_light(cell) + uint(LIGHT_ACTIONS);
}
