// The cell of a hit: find_cell().
#include "shared/variants.glsl"
#if CELLS == CELLS_GRID
#include "learning/grid.glsl"
#else
#include "learning/voronoi.glsl"
#endif
