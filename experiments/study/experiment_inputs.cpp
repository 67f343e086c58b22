#include "experiments/study/experiment_inputs.h"

#include <algorithm>

namespace qtrace::experiments {

ExperimentInputs::ExperimentInputs(const Experiment& experiment, SceneStore& scenes,
                                   const gpu::DeviceInfo& device) {
  runs_.reserve(experiment.runs.size());
  for (const Run& run : experiment.runs) {
    const View view = view_of(run.config);
    const auto environment = experiment.environment_image(run);
    const LoadedScene& scene = scenes.load(experiment.scene_file(run), view, environment);
    const LoadedScene& shown = scenes.load(experiment.reference_file(run), view, environment);
    ReferenceSpec reference = reference_spec(run.config, shown.hash);
    runs_.push_back(run_inputs(run, scene, shown, reference, device));
    specs_.emplace(reference.hash, std::move(reference));
  }
}

std::vector<ReferenceSpec> ExperimentInputs::references(const std::vector<Turn>& turns) const {
  std::vector<ReferenceSpec> needed;
  for (const Turn& turn : turns) {
    const RunInputs& inputs = of(turn);
    const auto same = std::ranges::find(needed, inputs.reference_hash, &ReferenceSpec::hash);
    if (same == needed.end()) {
      needed.push_back(specs_.at(inputs.reference_hash));
      needed.back().wish = inputs.wish;
    } else {
      same->wish = same->wish.joined(inputs.wish);
    }
  }
  return needed;
}

}  // namespace qtrace::experiments
