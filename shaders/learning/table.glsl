// Layout of the table: a row for every cell, with a column for every direction bin and then one for every light
// whose use is learned, and two for the mixture of BSDF and table where that is. A direction's value is the expected
// incident radiance, averaged over the channels; a light's is the mean square of what it contributes when it is chosen,
// in units of the brightest light. A mixture's is the mean square of what its directions brought by the BSDF, and by
// the table.
#if SAMPLER == SAMPLER_RL
#include "learning/bins.glsl"
#else
const int BINS = 0;
#endif
#ifdef LEARNS_MIXTURE
const int MIXTURE_COLUMNS = 2;
#else
const int MIXTURE_COLUMNS = 0;
#endif
const uint TABLE_COLUMNS = uint(BINS + LIGHT_COLUMNS + MIXTURE_COLUMNS);

// Place of a cell's mark, behind the sums of all cells: not 0 where the frame taught the cell something.
uint mark_of(uint cell) {
  return parameters.path.w * TABLE_COLUMNS * SUM_WORDS + cell;
}

uint first_bin(uint cell) {
  return cell * TABLE_COLUMNS;
}

uint first_light(uint cell) {
  return cell * TABLE_COLUMNS + uint(BINS);
}

uint first_share(uint cell) {
  return first_light(cell) + uint(LIGHT_COLUMNS);
}
