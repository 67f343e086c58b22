// What a run is made of, looked up once.
#pragma once

#include "engine/gpu/context.h"
#include "experiments/config/experiment_config.h"
#include "experiments/reference/reference.h"
#include "experiments/runtime/scene_store.h"

#include <string>

namespace qtrace::experiments {

// The scenes live as long as their store.
struct RunInputs {
  const LoadedScene* scene = nullptr;
  const LoadedScene* shown = nullptr;  // by its reference
  std::string config_hash;
  std::string reference_hash;
  ReferenceWish wish;
  std::string identity;  // of all that decides the run's bits: config, scenes, program and device
};

// `reference`: as reference_spec() has it of the run and the shown scene.
RunInputs run_inputs(const Run& run, const LoadedScene& scene, const LoadedScene& shown,
                     const ReferenceSpec& reference, const gpu::DeviceInfo& device);

}  // namespace qtrace::experiments
