// A better hierarchy out of a good one.
#pragma once

#include "engine/accel/bvh.h"

namespace qtrace {

// Takes subtrees out and puts them in where they enlarge boxes least, those of large boxes first: Bittner,
// Hapala & Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", in the batches of
// Meister & Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization". Leaves keep
// their triangles; the smaller child comes first, as walks take the first where a ray starts in both. The
// same whatever the number of threads.
void reinsert_subtrees(Bvh& bvh);

}  // namespace qtrace
