#include "experiments/run/run_inputs.h"

#include "experiments/config/config_hash.h"
#include "experiments/files/hash.h"
#include "experiments/runtime/version.h"

namespace qtrace::experiments {

RunInputs run_inputs(const Run& run, const LoadedScene& scene, const LoadedScene& shown,
                     const ReferenceSpec& reference, const gpu::DeviceInfo& device) {
  RunInputs inputs{&scene, &shown, config_hash(run.config, scene.hash), reference.hash, reference.wish, ""};
  const Json identity{{"config", inputs.config_hash},
                      {"save_table", enum_name(run.config.save_table)},
                      {"expect", write_knobs(run.config.expect)},
                      {"reference", inputs.reference_hash},
                      {"binary", binary_hash()},
                      {"renderer", device.renderer},
                      {"driver", device.gl_version}};
  inputs.identity = hash_text(canonical_text(identity));
  return inputs;
}

}  // namespace qtrace::experiments
