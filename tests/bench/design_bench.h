// What other designs of the tracing pass would cost: a wavefront, rays sorted or not, and shaders that hold
// what a scene does not use.
#pragma once

#include "tests/bench/frame_bench.h"

namespace qtrace::bench {

// Plain path tracing of simple and of a room of 200,000 triangles. Prints a table and writes designs.csv and
// design_rounds.csv.
void bench_designs(const gpu::Context& context, const FrameBenchOptions& options);

}  // namespace qtrace::bench
