// Configs as texts, for tests.
#pragma once

#include "experiments/config/experiment_config.h"
#include "tests/system/temp_folder.h"

#include <string>
#include <vector>

namespace qtrace::experiments {

// The config of a plain run with `extra` members in front.
inline std::string config_text(const std::string& extra) {
  return "{" + extra + R"("name": "test", "scene": "a.glb", "frames": 8})";
}

inline Experiment load(const std::string& text, const std::vector<std::string>& sets = {}) {
  const tests::TempFolder folder;
  return load_experiment(folder.write("c.json", text), sets);
}

}  // namespace qtrace::experiments
