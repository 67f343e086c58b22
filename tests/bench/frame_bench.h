// Milliseconds per frame of every configuration of an experiment.
#pragma once

#include "engine/gpu/context.h"
#include "engine/tracer/tracer.h"
#include "experiments/config/experiment_config.h"
#include "tests/bench/timing.h"

#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::bench {

struct FrameBenchOptions {
  int rounds = 0;
  int size = 0;  // pixels along a side of the image
  std::filesystem::path out;
};

// configs/paper_table.json with its settings resolved, one run for each configuration with independent random numbers, at
// this size.
experiments::Experiment paper_table(int size);

Duration timed_frame(const gpu::Context& context, Tracer& tracer);

// Whether this is the plain path tracer that others are compared with.
bool is_plain(const RenderSettings& settings);

// Prints a table and writes frames.csv and frame_rounds.csv.
void bench_frames(const gpu::Context& context, const FrameBenchOptions& options);

}  // namespace qtrace::bench
