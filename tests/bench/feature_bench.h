// What textures, materials and lights cost the frames of a scene that uses them.
#pragma once

#include "tests/bench/frame_bench.h"

namespace qtrace::bench {

// Path tracing with light samples of simple, plain and with one feature at a time. Prints a table and writes features.csv
// and feature_rounds.csv.
void bench_features(const gpu::Context& context, const FrameBenchOptions& options);

}  // namespace qtrace::bench
