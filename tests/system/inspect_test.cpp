// `qtrace inspect` as its users run it: files, figures, and what it refuses.
#include "tests/system/program.h"
#include "tests/system/small_scene.h"

#include "experiments/files/npy.h"
#include "experiments/images/exr.h"

#include <gtest/gtest.h>

namespace qtrace::tests {
namespace {

using experiments::ExrImage;
using experiments::read_exr;

class InspectProgram : public testing::Test {
 protected:
  InspectProgram() { write_small_scene(folder_, "scene"); }

  void run(const std::string& name, const std::string& members) const {
    folder_.write(
        name + ".json",
        small_config(
            name,
            members +
                R"("rl": {"bins_theta": 2, "bins_phi": 4, "sites_per_object": 100, "mixture": "fixed"}, )"));
    const Outcome outcome = run_qtrace({"run", name + ".json", "--quiet"}, folder_.path());
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  Outcome inspect(const std::string& run, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"inspect", run, "--samples", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_qtrace(arguments, folder_.path());
  }

  // Must fail with this message and without a trace on the disk.
  void expect_refused(const std::string& run, const std::string& message,
                      const std::vector<std::string>& more = {}) const {
    const std::vector<std::string> before = tree(folder_.path());
    const Outcome outcome = inspect(run, more);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_TRUE(outcome.err.starts_with("error: ")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, message)) << outcome.err;
    EXPECT_EQ(tree(folder_.path()), before);
  }

  TempFolder folder_;
};

const std::vector<std::string> kFloorPixel{"--pixel", "4,7"};

TEST_F(InspectProgram, ShowsTheTableThatWasSaved) {
  run("t", R"("save_table": "last", )");
  // Values and visits that no run would learn: each entry its own.
  const auto columns = experiments::read_npy<float>(folder_ / "results/t/run/q_values_000004.npy").columns;
  const auto rows = experiments::read_npy<float>(folder_ / "results/t/run/q_values_000004.npy").rows;
  ASSERT_EQ(columns, 8U);
  std::vector<float> values;
  std::vector<std::uint32_t> visits;
  for (std::uint32_t i = 0; i < rows * columns; ++i) {
    values.push_back(0.5F * static_cast<float>(i));
    visits.push_back(i);
  }
  experiments::write_npy<float>(folder_ / "results/t/run/q_values_000004.npy", columns, values);
  experiments::write_npy<std::uint32_t>(folder_ / "results/t/run/q_visits_000004.npy", columns, visits);

  const Outcome outcome = inspect("results/t/run", kFloorPixel);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const ExrImage cells = read_exr(folder_ / "results/t/run/inspect/cells.exr");
  EXPECT_EQ(cells.metadata.at("pixel"), "4,7");
  const auto cell = static_cast<std::size_t>(cells.channels.at("cell")[7 * 8 + 4]);
  EXPECT_LT(cell, 200U);  // the floor is the first object: 100 sites, two sides
  EXPECT_EQ(cell % 2, 0U);
  for (std::size_t i = 0; i < 64; ++i) {
    const float index = cells.channels.at("cell")[i];
    const float wanted = index < 0 ? 0 : 8 * (8 * index) + 28;  // of 8 consecutive numbers
    EXPECT_EQ(cells.channels.at("visits")[i], wanted);
    EXPECT_EQ(cells.channels.at("R")[i] > 0, index >= 0);
  }
  const ExrImage hemisphere = read_exr(folder_ / "results/t/run/inspect/hemisphere_4_7.exr");
  EXPECT_EQ(hemisphere.width, 192);
  EXPECT_EQ(hemisphere.channels.size(), 6U);
  for (std::size_t i = 0; i < hemisphere.channels.at("bin").size(); ++i) {
    const float bin = hemisphere.channels.at("bin")[i];
    const float entry = 8 * static_cast<float>(cell) + bin;
    EXPECT_EQ(hemisphere.channels.at("learned")[i], bin < 0 ? 0 : 0.5F * entry);
  }
  for (const char* part : {"pixel                              4,7\n", " of 400\n",
                           "table after frame                  4\n", "correlation over bins"}) {
    EXPECT_TRUE(contains(outcome.out, part)) << part << outcome.out;
  }
  EXPECT_TRUE(contains(outcome.out, "Files: results/t/run/inspect/cells.exr"));
}

TEST_F(InspectProgram, TakesTheFrameThatIsAskedFor) {
  run("f", R"("save_table": "snapshots", )");
  std::vector<std::string> arguments = kFloorPixel;
  arguments.insert(arguments.end(), {"--frame", "2"});
  const Outcome outcome = inspect("results/f/run", arguments);
  EXPECT_TRUE(contains(outcome.out, "table after frame                  2\n")) << outcome.out << outcome.err;
  expect_refused("results/f/run", "no table of frame 3 was saved; there are those of 1, 2, 4",
                 {"--frame", "3"});
}

TEST_F(InspectProgram, WhatCannotBeInspectedIsNamed) {
  run("none", "");
  run("last", R"("save_table": "last", )");
  run("bsdf", R"("sampler": "bsdf", "save_table": "last", )");
  expect_refused("results/nowhere", "results/nowhere: is not the folder of a run");
  expect_refused("results/last", "results/last: is the folder of an experiment; name one of the runs in it");
  expect_refused("results/none/run", "this run has saved no table; set save_table to last or snapshots");
  expect_refused("results/bsdf/run", "has learned no directions, because its sampler is bsdf");
  expect_refused("results/last/run", "--pixel 8,0 lies outside the image of 8 x 8", {"--pixel", "8,0"});
  expect_refused("results/last/run", "pixel 4,4 shows no surface that belongs to a cell");
  EXPECT_EQ(inspect("results/last/run", {"--pixel", "3"}).exit_code, 2);
  EXPECT_EQ(inspect("results/last/run", {"--samples", "0"}).exit_code, 2);
}

TEST_F(InspectProgram, FilesThatDoNotBelongToTheRunAreRefused) {
  run("a", R"("save_table": "last", )");
  const std::string base = "results/a/run/";
  const std::string manifest = folder_.read(base + "manifest.json");
  std::string other = manifest;
  other.replace(other.find("\"bins_phi\": 4"), 13, "\"bins_phi\": 5");
  folder_.write(base + "manifest.json", other);
  expect_refused("results/a/run", "is 400 x 8, but this run has 400 cells and 10 columns");
  folder_.write(base + "manifest.json", "{\"run\": 3, \"config\": {}}");
  expect_refused("results/a/run", "results/a/run/manifest.json: key 'name' is missing");
  folder_.write(base + "manifest.json", manifest);
  write_small_scene(folder_, "scene", Light::off);
  expect_refused("results/a/run", "scene.gltf: this scene has changed since the run");
  std::filesystem::remove(folder_ / "scene.gltf");
  expect_refused("results/a/run", "scene.gltf: the scene of this run is not there");
}

}  // namespace
}  // namespace qtrace::tests
