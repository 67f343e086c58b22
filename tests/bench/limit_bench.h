// Ray queries against what the device could do at most: arithmetic, fetches of nodes, and memory.
#pragma once

#include "engine/gpu/context.h"
#include "tests/bench/ray_bench.h"

namespace qtrace::bench {

// What a walk costs, counted by the shader itself, in units of three limits that are measured beside it:
// fused multiply-adds, fetches of nodes from the nearest cache, and a copy of memory.
// Prints a table and writes limits.csv and limit_rounds.csv.
void bench_limits(const gpu::Context& context, const RayBenchOptions& options);

}  // namespace qtrace::bench
