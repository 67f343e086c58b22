// What tests of whole experiments share: a folder with a small scene, and readers of what a run writes.
#pragma once

#include "tests/system/program.h"
#include "tests/system/small_scene.h"

#include "experiments/files/json.h"
#include "experiments/images/exr.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace qtrace::tests {

using experiments::Json;
using experiments::parse_json;
using experiments::read_exr;

// Fields by column name, one map per record; quotes and CRLF as in RFC 4180.
std::vector<std::map<std::string, std::string>> parse_csv(const std::string& text);

class RunProgram : public testing::Test {
 protected:
  RunProgram() { write_small_scene(folder_, "scene"); }

  // Runs a config of this name; extra arguments follow.
  Outcome run(const std::string& name, const std::string& members,
              const std::vector<std::string>& more = {}) const {
    folder_.write(name + ".json", small_config(name, members));
    std::vector<std::string> arguments{"run", name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_qtrace(arguments, folder_.path());
  }

  Json json(const std::string& file) const { return parse_json(folder_.read(file)); }

  TempFolder folder_;
};

constexpr const char* kMethods =
    R"("sweep": [{"method": {"NEE, one ray": {"sampler": "bsdf", "nee": "one_ray"}, "RL": {"sampler": "rl"}}},
                 {"seed": [1, 2]}], )";

}  // namespace qtrace::tests
