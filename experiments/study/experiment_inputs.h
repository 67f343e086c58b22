// The inputs of all runs of an experiment, looked up once.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/config/experiment_config.h"
#include "experiments/reference/reference.h"
#include "experiments/run/run_inputs.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/study/plan.h"

#include <map>
#include <string>
#include <vector>

namespace qtrace::experiments {

class ExperimentInputs {
 public:
  // The experiment and the store must live longer.
  ExperimentInputs(const Experiment& experiment, SceneStore& scenes, const gpu::DeviceInfo& device);

  const RunInputs& of(const Turn& turn) const { return runs_.at(turn.place); }

  // Each reference that these runs need, once, and as good as any of them wishes it: its length shall not
  // depend on the order of the runs.
  std::vector<ReferenceSpec> references(const std::vector<Turn>& turns) const;

 private:
  std::vector<RunInputs> runs_;                 // in the order of the config
  std::map<std::string, ReferenceSpec> specs_;  // by hash, with the wish of the first run that has it
};

}  // namespace qtrace::experiments
