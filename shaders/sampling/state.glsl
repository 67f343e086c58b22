// What the table knows of a scattering event.
#include "sampling/direction.glsl"
#include "sampling/event.glsl"
#include "shared/counters.glsl"
#include "shared/structs.glsl"
#include "shared/variants.glsl"
#ifdef HAS_TABLE
#include "learning/cells.glsl"
#endif

// The event's cell, where that is needed, and whether the table guides from there, where it may.
void find_state(inout Event e, inout Tally tally, bool needs_cell, bool may_guide) {
#ifdef HAS_TABLE
  e.cell = no_cell(e.surface);
  if (needs_cell) {
    e.cell = find_cell(e.surface);
    ++tally.lookups;
    if (e.cell.index == NO_CELL) ++tally.fallbacks;
  }
#endif
#if SAMPLER == SAMPLER_RL
  e.is_guided = e.cell.index != NO_CELL && may_guide;
  e.bsdf_share = bsdf_share_of(e);
#endif
}
