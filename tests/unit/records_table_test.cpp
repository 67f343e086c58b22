// summary.md from records that are made up.
#include "experiments/files/text_table.h"
#include "experiments/records/summary_page.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

RunRecord record(const std::string& scene, const std::string& method, double host_ms, double relmse) {
  RunRecord result;
  result.run = {scene + method, scene + " / " + method, {scene, method}, {}};
  result.scene = scene;
  result.status = RunStatus::finished;
  FrameRecord frame;
  frame.host_ms = host_ms;
  frame.gpu_ms = host_ms;
  frame.elapsed_s = host_ms / 1e3;
  result.frames = {frame};
  SnapshotRecord snapshot;
  snapshot.errors.relmse = relmse;
  snapshot.errors.mse = relmse;
  result.snapshots = {snapshot};
  return result;
}

Experiment experiment() {
  Experiment result;
  result.name = "demo";
  result.axes = {Axis{"scene", false, {}}, Axis{"method", false, {}}};
  result.published.source = "A report";
  result.published.note = "Ratios alone are comparable.";
  result.published.ms_per_frame.by_configuration = {{"simple / NEE", 76}, {"simple / RL", 33}};
  result.published.ratio = {"NEE", "RL"};
  return result;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(RecordsTable, ShowsPublishedFiguresAndRatiosBesideMeasuredOnes) {
  const std::string table = experiment_table(
      experiment(),
      {record("simple", "NEE", 30, 0.5), record("simple", "RL", 20, 0.25), record("dark", "RL", 1, 1)}, {},
      "a device");
  EXPECT_TRUE(contains(table, "Device: a device"));
  EXPECT_TRUE(contains(table, "## simple"));
  EXPECT_TRUE(contains(table, "## dark"));
  EXPECT_TRUE(contains(table, "published ms"));
  EXPECT_TRUE(contains(table, " 30 [30, 30] |")) << table;
  EXPECT_TRUE(contains(table, " 76 |"));
  EXPECT_TRUE(contains(table,
                       "- simple / NEE over simple / RL: 1.5 × the host time per frame (published: 2.30 ×); "
                       "3 × the relMSE × s"))
      << table;
  EXPECT_TRUE(contains(table, "Ratios alone are comparable."));
}

TEST(RecordsTable, WithoutPublishedFiguresHasNoColumnForThem) {
  Experiment plain = experiment();
  plain.published = {};
  const std::string table = experiment_table(plain, {record("simple", "NEE", 30, 0.5)}, {}, "d");
  EXPECT_FALSE(contains(table, "ublished"));
  EXPECT_FALSE(contains(table, "host time per frame"));
}

TEST(RecordsTable, FilteredImagesHaveRowsAndAColumnOfTheirOwn) {
  RunRecord noisy = record("simple", "RL", 20, 0.5);
  EXPECT_FALSE(contains(experiment_table(experiment(), {noisy}, {}, "d"), "iltered"));
  RunRecord filtered = record("simple", "NEE", 30, 0.25);
  filtered.snapshots[0].filtered = FilteredRecord{{}, 1};
  filtered.snapshots[0].filtered->errors.relmse = 0.125;
  const std::string table = experiment_table(experiment(), {noisy, filtered}, {}, "d");
  EXPECT_TRUE(contains(table, "| relMSE | relMSE filtered (biased) |")) << table;
  EXPECT_TRUE(contains(table, "|   0.25 |                        - |")) << table;
  EXPECT_TRUE(contains(table, "| NEE, à-trous (biased) |")) << table;
  EXPECT_TRUE(contains(table, "|      - |                    0.125 |")) << table;
  EXPECT_FALSE(contains(table, "RL, à-trous")) << table;
}

TEST(RecordsTable, FilteredImagesAreToldApartWithoutAxesToo) {
  Experiment plain = experiment();
  plain.axes.clear();
  RunRecord run = record("simple", "NEE", 30, 0.25);
  run.run.labels.clear();
  run.snapshots[0].filtered = FilteredRecord{};
  const std::string table = experiment_table(plain, {run}, {}, "d");
  EXPECT_TRUE(contains(table, "| image            |")) << table;
  EXPECT_TRUE(contains(table, "| mean             |")) << table;
  EXPECT_TRUE(contains(table, "| à-trous (biased) |")) << table;
}

TEST(RecordsTable, FirefliesHaveAColumnAndClampingALine) {
  RunRecord run = record("simple", "RL", 20, 0.5);
  run.frames[0].counters.paths = 1'000'000;
  run.frames[0].counters.fireflies = 12;
  run.frames[0].counters.clamped_samples = 34;
  std::string table = experiment_table(experiment(), {run}, {}, "d");
  EXPECT_TRUE(contains(table, "| fireflies / M samples |")) << table;
  EXPECT_TRUE(contains(table, "|                    12 |")) << table;
  EXPECT_FALSE(contains(table, "lamp")) << table;
  run.run.config.render.clamp_radiance = 10;
  run.snapshots[0].clamp_bias = -0.5;
  table = experiment_table(experiment(), {run}, {}, "d");
  EXPECT_TRUE(
      contains(table,
               "- simple / RL: clamped (biased): clamp_radiance 10 scaled down 34 samples and changed "
               "the mean by -0.5\n"))
      << table;
}

TEST(RecordsTable, NamesFailedRunsAndFlagsTheFloor) {
  RunRecord failed = record("simple", "RL", 1, 1);
  failed.status = RunStatus::failed;
  failed.reason = "the device was lost";
  RunRecord at_floor = record("simple", "NEE", 1, 1);
  at_floor.snapshots[0].errors.reference = ReferenceNoise{1, 1};
  const std::string table = experiment_table(experiment(), {failed, at_floor}, {}, "d");
  EXPECT_TRUE(contains(table, "Failed runs:\n- simpleRL: the device was lost"));
  EXPECT_TRUE(contains(table, "1 of 1 |"));
  EXPECT_TRUE(contains(table, " 0/1 |"));
  EXPECT_TRUE(contains(table, "not measured"));
}

TEST(RecordsTable, FieldsAreAlignedByCharactersAndEscaped) {
  EXPECT_EQ(markdown_table({"a|b", "n"}, {{"±", "12345"}}, 1),
            "| a\\|b |     n |\n"
            "|------|------:|\n"
            "| ±    | 12345 |\n");
}

}  // namespace
}  // namespace qtrace::experiments
