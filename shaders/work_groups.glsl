// Which part of a dispatch a work group does. llvmpipe gives each of its threads one contiguous run of groups and waits
// for the last thread, so that half an image each would take as long as its costlier half. Here each thread does every
// WORK_THREADS-th piece of WORK_PIECE neighbouring groups instead. Nothing but time depends on it.
#if WORK_THREADS > 1

// Long enough that threads stream through memory of their own, short enough that small images have some for each.
#ifndef WORK_PIECE
#define WORK_PIECE 16
#endif

uint dealt_group() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint groups = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
  uint share = groups / uint(WORK_THREADS * WORK_PIECE) * uint(WORK_PIECE);  // of a thread
  if (group >= share * uint(WORK_THREADS)) return group;  // what does not divide
  uint place = group % share;
  uint piece = place / uint(WORK_PIECE) * uint(WORK_THREADS) + group / share;
  return piece * uint(WORK_PIECE) + place % uint(WORK_PIECE);
}

#else

uint dealt_group() {
  return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

#endif
