// save_table: which files a run leaves, and that NumPy reads in them what the program does.
#include "tests/system/program.h"
#include "tests/system/small_scene.h"

#include "experiments/files/npy.h"
#include "experiments/run/saved_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace qtrace::tests {
namespace {

using experiments::read_npy;

constexpr const char* kTable = R"("rl": {"sites_per_object": 3, "bins_theta": 2, "bins_phi": 4}, )";

class SavedTables : public testing::Test {
 protected:
  SavedTables() { write_small_scene(folder_, "scene"); }

  // Names of the .npy files that a run leaves.
  std::vector<std::string> files_of(const std::string& name, const std::string& members) const {
    folder_.write(name + ".json", small_config(name, members));
    const Outcome outcome = run_qtrace({"run", name + ".json"}, folder_.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::vector<std::string> names;
    for (const std::string& file : tree(folder_ / ("results/" + name + "/run"))) {
      if (file.ends_with(".npy")) names.push_back(file);
    }
    return names;
  }

  TempFolder folder_;
};

TEST_F(SavedTables, AreSavedWhenAskedFor) {
  EXPECT_TRUE(files_of("none", "").empty());
  EXPECT_EQ(files_of("last", R"("save_table": "last", )"),
            (std::vector<std::string>{"cells.npy", "q_values_000004.npy", "q_visits_000004.npy"}));
  EXPECT_EQ(files_of("all", R"("snapshots": [3], "save_table": "snapshots", )"),
            (std::vector<std::string>{"cells.npy", "q_values_000003.npy", "q_values_000004.npy",
                                      "q_visits_000003.npy", "q_visits_000004.npy"}));
}

TEST_F(SavedTables, WithoutATableThereIsAWarning) {
  EXPECT_TRUE(files_of("bsdf", R"("sampler": "bsdf", "save_table": "last", )").empty());
  EXPECT_NE(
      folder_.read("results/bsdf/run/manifest.json").find("save_table is last, but there is nothing to save"),
      std::string::npos);
}

TEST_F(SavedTables, SavingChangesNeitherImageNorHash) {
  files_of("off", "");
  files_of("on", R"("save_table": "snapshots", )");
  // The images carry the hash of their config.
  EXPECT_EQ(folder_.read("results/off/run/frame_000004.exr"),
            folder_.read("results/on/run/frame_000004.exr"));
}

TEST_F(SavedTables, HoldWhatWasLearned) {
  files_of("t", std::string(kTable) + R"("save_table": "snapshots", )");
  const std::filesystem::path run = folder_ / "results/t/run";
  const experiments::SavedTable table = experiments::read_saved_table(run, std::nullopt);
  EXPECT_EQ(table.frame, 4);
  EXPECT_EQ(table.values.rows, 2U * 2 * 3);  // objects, sides, sites
  EXPECT_EQ(table.values.columns, 8U + 2);   // directions, and both sides of the mixture
  EXPECT_EQ(experiments::read_saved_table(run, 2).frame, 2);
  // A visited entry may have learned of darkness; an unvisited one has learned nothing.
  std::size_t learned = 0;
  for (std::size_t i = 0; i < table.values.values.size(); ++i) {
    EXPECT_GE(table.values.values[i], 0);
    EXPECT_FALSE(table.values.values[i] > 0 && table.visits.values[i] == 0);
    if (table.values.values[i] > 0) ++learned;
  }
  EXPECT_GT(learned, 0U);
  const auto cells = read_npy<float>(run / "cells.npy");
  ASSERT_EQ(cells.rows, table.values.rows);
  ASSERT_EQ(cells.columns, 7U);
  for (std::size_t i = 0; i < cells.rows; ++i) {
    const float* row = &cells.values[7 * i];
    EXPECT_EQ(row[1], row[6] == 0 ? 0.0F : 2.0F) << i;  // the floor, and the panel two above it
    EXPECT_NEAR(std::abs(row[4]), 1, 1e-6);
  }
}

TEST_F(SavedTables, NumPyReadsThem) {
  files_of("np", std::string(kTable) + R"("save_table": "last", )");
  const std::filesystem::path run = folder_ / "results/np/run";
  const auto values = read_npy<float>(run / "q_values_000004.npy");
  const auto visits = read_npy<std::uint32_t>(run / "q_visits_000004.npy");
  double sum = 0;
  for (const float value : values.values) sum += value;
  std::uint64_t count = 0;
  for (const std::uint32_t visit : visits.values) count += visit;
  const std::string script = fmt::format(
      "import numpy as np\n"
      "v, n, c = (np.load('{0}/' + f + '.npy') for f in ('q_values_000004', 'q_visits_000004', 'cells'))\n"
      "assert v.shape == n.shape == ({1}, {2}) and c.shape == ({1}, 7), (v.shape, n.shape, c.shape)\n"
      "assert (v.dtype, n.dtype, c.dtype) == (np.float32, np.uint32, np.float32)\n"
      "assert abs(v.sum(dtype=float) - {3}) < 1e-9 and n.sum() == {4}, (v.sum(dtype=float), n.sum())\n"
      "assert v[1, 2] == np.float32({5}) and n[1, 2] == {6}\n",
      run.string(), values.rows, values.columns, sum, count, values.values[values.columns + 2],
      visits.values[visits.columns + 2]);
  folder_.write("check.py", script);
  EXPECT_EQ(std::system(("/usr/bin/python3 " + (folder_ / "check.py").string()).c_str()), 0) << script;
}

TEST_F(SavedTables, WhatDoesNotFitIsNamed) {
  const auto error_of = [this](std::optional<int> frame) -> std::string {
    try {
      experiments::read_saved_table(folder_.path(), frame);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(error_of({}).find("this run has saved no table; set save_table"), std::string::npos);
  const std::vector<float> values(6);
  experiments::write_npy<float>(folder_ / "q_values_000002.npy", 3, values);
  EXPECT_NE(error_of(4).find("no table of frame 4 was saved; there are those of 2"), std::string::npos);
  EXPECT_NE(error_of({}).find("q_visits_000002.npy: cannot be read"), std::string::npos);
  experiments::write_npy<std::uint32_t>(folder_ / "q_visits_000002.npy", 2, std::vector<std::uint32_t>(6));
  EXPECT_NE(error_of({}).find("is 3 x 2, but the values of the same frame are 2 x 3"), std::string::npos);
}

}  // namespace
}  // namespace qtrace::tests
