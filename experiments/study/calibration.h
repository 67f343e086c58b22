// How long runs will take, by some frames of each configuration.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/runtime/progress.h"
#include "experiments/study/experiment_inputs.h"
#include "experiments/study/plan.h"

#include <map>
#include <string>
#include <vector>

namespace qtrace::experiments {

struct Speed {
  double setup_s = 0;
  double frame_s = 0;
};

// A tracer's first frames, the very first left out: at most 16, or half a second.
Speed measure_speed(const gpu::Context& context, const Scene& scene, const RenderSettings& settings);

// One configuration's speed for all of its runs; of many configurations, some that are evenly spread stand
// for the others.
class Calibration {
 public:
  // Measures.
  Calibration(const Experiment& experiment, const std::vector<Turn>& turns, const gpu::Context& context,
              const ExperimentInputs& inputs, Progress& progress);

  double seconds(const Run& run, int frames) const;  // setup included; 0 for no frames
  std::string text() const;                          // "measured on all 12 configurations"

 private:
  Speed mean() const;

  std::map<std::string, Speed> speeds_;  // by configuration
  std::size_t configurations_ = 0;
};

}  // namespace qtrace::experiments
