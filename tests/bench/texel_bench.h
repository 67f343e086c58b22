// Where texels may live, and who filters them: what a look-up costs.
#pragma once

#include "tests/bench/frame_bench.h"

namespace qtrace::bench {

// Bilinear look-ups at random places of an image of 1024 x 1024. Prints a table and writes texels.csv and texel_rounds.csv.
void bench_texels(const gpu::Context& context, const FrameBenchOptions& options);

}  // namespace qtrace::bench
