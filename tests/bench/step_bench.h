// What each step of reinforcement learning costs, as a share of the frame.
#pragma once

#include "engine/gpu/context.h"
#include "tests/bench/frame_bench.h"

namespace qtrace::bench {

// Of the configurations of Goswami's table that learn directions. Throws Error where the frame taken apart does not
// render the tracer's image. Prints a table and writes steps.csv and step_rounds.csv.
//   a pass of its own (learning, accumulation) is timed as such;
//   a step within the tracing shader is the difference that it makes to the time of that pass: look-up and
//   drawing when they are done twice, which finds its data in the caches, and so the least that they cost;
//   gathering of targets, their computation included, when it is left out.
void bench_steps(const gpu::Context& context, const FrameBenchOptions& options);

}  // namespace qtrace::bench
