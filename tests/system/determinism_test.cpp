// The same seed gives the same bits with any number of threads of the software driver.
#include "tests/system/program.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

namespace qtrace::tests {
namespace {

// Long enough for frames that do not teach, and for the trial that may give the table up (by power alone).
constexpr const char* kConfig = R"({
  "name": "bits", "scene": ")" QTRACE_SOURCE_DIR
                                R"(/configs/scenes/cornell_box.glb", "width": 40, "height": 40, "frames": 28,
  "save_table": "last", "reference": { "frames": 4 }, "sampler": "rl",
  "rl": { "sites_per_object": 30, "bins_theta": 4, "bins_phi": 6 },
  "sweep": [ { "method": {
    "paths": { "nee": "none", "rl.update": "expected_sarsa" },
    "whole paths": { "nee": "none", "rl.update": "monte_carlo" },
    "learned lights": { "nee": "one_ray", "rl.update": "expected_sarsa", "lights": "learned" },
    "light paths": { "nee": "one_ray", "rl.update": "monte_carlo", "light_paths": "connect", "light_path_trial": 0 },
    "two rays": { "nee": "two_ray", "rl.update": "expected_sarsa" },
    "two rays, learned lights": { "nee": "two_ray", "rl.update": "monte_carlo", "lights": "learned" } } } ]
})";

// A variable of the environment for as long as it lives, and then as it was; programs that are started
// inherit it.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (before_) {
      ::setenv(name_, before_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(Determinism, ThreadsDoNotChangeABit) {
  const TempFolder folder;
  folder.write("bits.json", kConfig);
  const char* const threads[] = {"2", "1", "4", "0"};  // 0: none besides the program's own
  for (const char* count : threads) {
    const Environment environment("LP_NUM_THREADS", count);
    const Outcome outcome = run_qtrace({"run", "bits.json", "--quiet", "--out", count}, folder.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  int compared = 0;
  for (const std::string& name : tree(folder / "2")) {
    if (!name.ends_with(".exr") && !name.ends_with(".npy")) continue;
    const std::string truth = folder.read("2/" + name);
    for (const char* count : threads) {
      EXPECT_TRUE(folder.read(std::string(count) + '/' + name) == truth) << count << " threads: " << name;
    }
    ++compared;
  }
  EXPECT_EQ(compared,
            6 * (6 + 1 + 3) + 1);  // snapshots, first hits and tables of every run, and the reference
}

}  // namespace
}  // namespace qtrace::tests
