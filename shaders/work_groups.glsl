// Which part of a dispatch a work group does. llvmpipe gives each of its threads one contiguous run of groups and waits
// for the last thread, so that half an image each would take as long as its costlier half. Here each thread does every
// WORK_THREADS-th piece of at most WORK_PIECE neighbouring groups instead. Nothing but time depends on it.
#if WORK_THREADS > 1

// Long enough that threads stream through memory of their own, short enough that each has some of a small image.
#ifndef WORK_PIECE
#define WORK_PIECE 16
#endif
const uint LEAST_PIECES = 8u;  // of a thread

uint dealt_group() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  uint piece = clamp(groups / (uint(WORK_THREADS) * LEAST_PIECES), 1u, uint(WORK_PIECE));
  uint share = groups / (uint(WORK_THREADS) * piece) * piece;  // of a thread
  if (group >= share * uint(WORK_THREADS)) return group;       // what does not divide
  uint place = group % share;
  return (place / piece * uint(WORK_THREADS) + group / share) * piece + place % piece;
}

#else

uint dealt_group() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

#endif
