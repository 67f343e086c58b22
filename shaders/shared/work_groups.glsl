// Which part of a dispatch a work group does. Where the driver gives each of its threads one contiguous run of groups
// (shaders/README.md), half an image each would take as long as its costlier half. Here each thread does every
// WORK_THREADS-th piece of neighbouring groups instead. Nothing but time depends on it.

// Pieces of up to 2^WORK_PIECE_BITS groups: long enough that threads stream through memory of their own, short enough
// that each has some of a small image.
#ifndef WORK_PIECE_BITS
#define WORK_PIECE_BITS 4
#endif
const uint LEAST_PIECES = 8u;  // of a thread

uint dealt_group() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
#if WORK_THREADS > 1
  uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  uint bits = uint(clamp(findMSB(groups / (uint(WORK_THREADS) * LEAST_PIECES)), 0, WORK_PIECE_BITS));
  uint share = (groups >> bits) / uint(WORK_THREADS) << bits;  // of a thread
  if (group >= share * uint(WORK_THREADS)) return group;       // what does not divide
  uint thread = group / share;
  uint place = group - thread * share;
  return (((place >> bits) * uint(WORK_THREADS) + thread) << bits) + (place & ((1u << bits) - 1u));
#else
  return group;
#endif
}
