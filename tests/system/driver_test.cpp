// What suits the driver: measured once and kept, the same for all of an experiment, and without effect on images.
#include "experiments/files/json.h"
#include "tests/system/program.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace qtrace::tests {
namespace {

using experiments::Json;
namespace fs = std::filesystem;

constexpr const char* kConfig = R"({
  "name": "driver", "scene": ")" QTRACE_SOURCE_DIR
                                R"(/configs/scenes/cornell_box.glb", "width": 16, "height": 16, "frames": 4,
  "reference": { "frames": 4 }, "sampler": "rl",
  "rl": { "sites_per_object": 10, "bins_theta": 2, "bins_phi": 4 }, "sweep": [ { "seed": [1, 2] } ]
})";

class DriverOfAnExperiment : public testing::Test {
 protected:
  DriverOfAnExperiment() {
    ::unsetenv("QTRACE_DRIVER");
    ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    folder_.write("driver.json", kConfig);
  }
  ~DriverOfAnExperiment() override {
    ::unsetenv("XDG_CACHE_HOME");
    ::unsetenv("QTRACE_DRIVER");
  }

  Outcome run(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"run", "driver.json", "--out", out};
    words.insert(words.end(), more.begin(), more.end());
    return run_qtrace(words, folder_.path());
  }
  Json device(const std::string& out) const {
    return experiments::read_json_file(folder_ / (out + "/driver/manifest.json")).at("device");
  }
  fs::path kept_file() const {
    for (const auto& entry : fs::directory_iterator(folder_ / "cache/qtrace")) return entry.path();
    return {};
  }

  const TempFolder folder_;
};

TEST_F(DriverOfAnExperiment, IsMeasuredOnceAndKept) {
  const Outcome first = run("first");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(contains(first.err, "measured what suits this driver")) << first.err;
  const fs::path kept = kept_file();
  EXPECT_EQ(experiments::read_json_file(kept).at("device"), device("first"));
  const Outcome second = run("second");
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_FALSE(contains(second.err, "measured what suits")) << second.err;
  EXPECT_EQ(device("second"), device("first"));
  write_text(kept, "{ \"binary\": ");
  const Outcome third = run("third");
  EXPECT_EQ(third.exit_code, 0) << third.err;
  EXPECT_TRUE(contains(third.err, "measured what suits this driver")) << third.err;
}

TEST_F(DriverOfAnExperiment, StaysAsItWasBegun) {
  ::setenv("QTRACE_DRIVER", "fetch=texture,stack=memory,work_threads=1", 1);
  ASSERT_EQ(run("results", {"--only", "seed=1"}).exit_code, 1);  // the other run is missing
  ::unsetenv("QTRACE_DRIVER");
  const Outcome rest = run("results");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(device("results").at("buffer_fetch"), "texture");
  EXPECT_EQ(device("results").at("traversal_stack"), "memory");
  EXPECT_EQ(device("results").at("work_threads"), 1);
  ::setenv("QTRACE_DRIVER", "stack=registers", 1);
  const Outcome other = run("results");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_TRUE(contains(other.err, "the device's 'traversal_stack' was \"memory\" and is \"registers\"")) << other.err;
}

// Shards have no manifest in common before they are merged.
TEST_F(DriverOfAnExperiment, IsTheSameForAllShards) {
  ::setenv("QTRACE_DRIVER", "fetch=texture,stack=memory,work_threads=1", 1);
  ASSERT_EQ(run("probe").exit_code, 0);
  ::unsetenv("QTRACE_DRIVER");
  // As a first shard leaves it behind that has measured otherwise.
  fs::create_directories(folder_ / "results/driver");
  write_text(folder_ / "results/driver/.driver.json", Json{{"device", device("probe")}}.dump());
  for (const std::string shard : {"1/2", "2/2"}) {
    const Outcome outcome = run("results", {"--shard", shard});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  ASSERT_EQ(run("results", {"--merge"}).exit_code, 0);
  EXPECT_EQ(device("results"), device("probe"));
}

TEST_F(DriverOfAnExperiment, ChangesNoBit) {
  const std::vector<std::string> ways{"fetch=image,stack=registers", "fetch=texture,stack=memory,work_threads=3",
                                      "fetch=storage,stack=registers,work_threads=1"};
  for (std::size_t i = 0; i < ways.size(); ++i) {
    ::setenv("QTRACE_DRIVER", ways[i].c_str(), 1);
    const Outcome outcome = run(std::to_string(i));
    if (i == 0 && contains(outcome.err, "does not offer")) GTEST_SKIP() << outcome.err;
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  for (const std::string& name : tree(folder_ / "0")) {
    if (!name.ends_with(".exr")) continue;
    EXPECT_TRUE(folder_.read("0/" + name) == folder_.read("1/" + name)) << name;
    EXPECT_TRUE(folder_.read("0/" + name) == folder_.read("2/" + name)) << name;
  }
}

TEST_F(DriverOfAnExperiment, WhatIsForcedIsCheckedFirst) {
  ::setenv("QTRACE_DRIVER", "fetch=images", 1);
  const Outcome outcome = run("results");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "'fetch=images' is none of fetch=texture|image|storage")) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "results/driver"));
}

}  // namespace
}  // namespace qtrace::tests
