// CSV after RFC 4180, and the columns.
#include "experiments/records/columns.h"
#include "experiments/records/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>

namespace qtrace::experiments {
namespace {

TEST(RecordsCsv, QuotesOnlyWhatNeedsIt) {
  EXPECT_EQ(csv_field(std::string("plain text")), "plain text");
  EXPECT_EQ(csv_field(std::string("NEE, two rays")), "\"NEE, two rays\"");
  EXPECT_EQ(csv_field(std::string("say \"x\"")), "\"say \"\"x\"\"\"");
  EXPECT_EQ(csv_field(std::string("two\nlines")), "\"two\nlines\"");
  EXPECT_EQ(csv_field(std::string("a\rb")), "\"a\rb\"");
  EXPECT_EQ(csv_field(std::string("")), "");
}

TEST(RecordsCsv, NumbersReadBackExactly) {
  for (const double value : {0.1, 1.0 / 3, 6.02e23, -1e-300, 0.0}) {
    EXPECT_EQ(std::strtod(csv_field(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(csv_field(1.5), "1.5");
  EXPECT_EQ(csv_field(std::uint64_t{18446744073709551615U}), "18446744073709551615");
  EXPECT_EQ(csv_field(true), "1");
  EXPECT_EQ(csv_field({}), "");
}

TEST(RecordsCsv, TextHasAHeaderAndLinesEndInCrLf) {
  const std::vector<Column<int>> columns{{"n", [](const int& n) { return CsvValue(std::int64_t{n}); }},
                                         {"half, of n", [](const int& n) { return CsvValue(n / 2.0); }}};
  EXPECT_EQ(csv_text(columns, std::vector<int>{1, 4}), "n,\"half, of n\"\r\n1,0.5\r\n4,2\r\n");
  EXPECT_EQ(csv_text(columns, std::vector<int>{}), "n,\"half, of n\"\r\n");
}

template <class Row>
void expect_distinct(const std::vector<Column<Row>>& columns) {
  std::set<std::string> names;
  for (const auto& column : columns) EXPECT_TRUE(names.insert(column.name).second) << column.name;
}

// The field of one column.
template <class Row>
std::string field(const std::vector<Column<Row>>& columns, const Row& row, const std::string& name) {
  for (const auto& column : columns) {
    if (column.name == name) return csv_field(column.get(row));
  }
  return "no such column";
}

FrameRecord frame_record(int frame, double host_ms, double elapsed_s) {
  FrameRecord record;
  record.frame = frame;
  record.is_warmup = frame == 1;
  record.host_ms = host_ms;
  record.gpu_ms = host_ms / 2;
  record.elapsed_s = elapsed_s;
  record.counters.paths = 10;
  record.counters.path_segments = 25;
  record.counters.zero_paths = 4;
  record.counters.non_finite = 1;
  record.counters.fireflies = 2;
  record.counters.clamped_samples = 5;
  return record;
}

// Three frames of 100, 2 and 4 ms, the first to warm up; relmse 0.5.
RunRecord run_record(const std::string& configuration, std::uint32_t seed, double relmse) {
  RunRecord record;
  record.run.id = configuration + "-" + std::to_string(seed);
  record.run.configuration = configuration;
  record.run.labels = {configuration, std::to_string(seed)};
  record.run.config.render.seed = seed;
  record.run.config.frames = 3;
  record.scene = "box";
  record.status = RunStatus::finished;
  record.frames = {frame_record(1, 100, 0.1), frame_record(2, 2, 0.102), frame_record(3, 4, 0.106)};
  SnapshotRecord snapshot;
  snapshot.frame = 3;
  snapshot.errors.relmse = relmse;
  snapshot.clamp_bias = -relmse / 8;
  record.snapshots = {snapshot};
  return record;
}

TEST(Records, FrameColumns) {
  const auto columns = frame_columns();
  expect_distinct(columns);
  const FrameRecord row = frame_record(1, 100, 0.1);
  EXPECT_EQ(field(columns, row, "is_warmup"), "1");
  EXPECT_EQ(field(columns, row, "gpu_ms"), "50");
  EXPECT_EQ(field(columns, row, "mean_path_length"), "2.5");
  EXPECT_EQ(std::stod(field(columns, row, "zero_path_fraction")), 0.4);
  EXPECT_EQ(field(columns, row, "fireflies"), "2");
  EXPECT_EQ(field(columns, row, "clamped_samples"), "5");
  FrameRecord empty;
  EXPECT_EQ(field(columns, empty, "mean_path_length"), "");
}

TEST(Records, SnapshotColumnsLeaveUnknownNoiseEmpty) {
  const auto columns = snapshot_columns();
  expect_distinct(columns);
  SnapshotRecord row;
  row.frame = 8;
  row.errors.relmse = 0.25;
  EXPECT_EQ(field(columns, row, "spp"), "8");
  EXPECT_EQ(field(columns, row, "relmse"), "0.25");
  EXPECT_EQ(field(columns, row, "reference_relmse"), "");
  EXPECT_EQ(field(columns, row, "relmse_corrected"), "");
  EXPECT_EQ(field(columns, row, "flip"), "");  // not asked for
  row.errors.smape = 0.5;
  row.errors.psnr_db = 12;
  row.errors.flip = 0.0625;
  EXPECT_EQ(field(columns, row, "smape"), "0.5");
  EXPECT_EQ(field(columns, row, "psnr_db"), "12");
  EXPECT_EQ(field(columns, row, "flip"), "0.0625");
  row.errors.reference = ReferenceNoise{1, 0.125};
  EXPECT_EQ(field(columns, row, "reference_relmse"), "0.125");
  EXPECT_EQ(field(columns, row, "relmse_corrected"), "0.125");
  EXPECT_EQ(field(columns, row, "mse_corrected"), "-1");
  EXPECT_EQ(field(columns, row, "at_reference_floor"), "1");
}

TEST(Records, FilteredErrorsHaveColumnsOfTheirOwn) {
  const auto columns = filtered_columns();
  expect_distinct(columns);
  SnapshotRecord row;
  row.frame = 4;
  row.errors.relmse = 1;
  EXPECT_EQ(field(columns, row, "filtered_relmse"), "");
  row.filtered = FilteredRecord{{}, 12.5};
  row.filtered->errors.relmse = 0.25;
  EXPECT_EQ(field(columns, row, "spp"), "4");
  EXPECT_EQ(field(columns, row, "relmse"), "no such column");
  EXPECT_EQ(field(columns, row, "filtered_relmse"), "0.25");
  EXPECT_EQ(field(columns, row, "filter_ms"), "12.5");
  EXPECT_EQ(field(snapshot_columns(), row, "relmse"), "1");
  EXPECT_EQ(field(snapshot_columns(), row, "filtered_relmse"), "no such column");
}

TEST(Records, FirefliesClampingAndFilteringAreSummedUp) {
  const auto columns = run_columns({});
  RunRecord row = run_record("a", 1, 0.5);
  EXPECT_EQ(field(columns, row, "fireflies"), "6");
  EXPECT_EQ(field(columns, row, "fireflies_per_million"), "200000");
  EXPECT_EQ(field(columns, row, "firefly_energy_fraction"), "");
  EXPECT_EQ(field(columns, row, "brightest_firefly"), "");
  EXPECT_EQ(field(columns, row, "clamped_samples"), "15");
  EXPECT_EQ(field(columns, row, "clamp_bias"), "-0.0625");
  EXPECT_EQ(field(columns, row, "filtered_relmse"), "");
  EXPECT_EQ(field(columns, row, "filter_ms"), "");
  row.fireflies = {0.125, 1000};
  row.snapshots[0].filtered = FilteredRecord{{}, 3};
  row.snapshots[0].filtered->errors.relmse = 0.25;
  EXPECT_EQ(field(columns, row, "firefly_energy_fraction"), "0.125");
  EXPECT_EQ(field(columns, row, "brightest_firefly"), "1000");
  EXPECT_EQ(field(columns, row, "filtered_relmse"), "0.25");
  EXPECT_EQ(field(columns, row, "relmse"), "0.5");
  EXPECT_EQ(field(columns, row, "filter_ms"), "3");
}

TEST(Records, WarmupIsOutOfTheMedianAndInTheTotal) {
  const auto columns = run_columns({Axis{"method", false, {}}, Axis{"seed", true, {}}});
  expect_distinct(columns);
  const RunRecord row = run_record("NEE, two rays", 3, 0.5);
  EXPECT_EQ(field(columns, row, "host_ms_median"), "3");
  EXPECT_EQ(field(columns, row, "gpu_ms_median"), "1.5");
  EXPECT_EQ(field(columns, row, "host_ms_iqr"), "1");
  EXPECT_EQ(std::stod(field(columns, row, "elapsed_s")), 0.106);
  EXPECT_EQ(std::stod(field(columns, row, "relmse_x_s")), 0.5 * 0.106);
  EXPECT_EQ(field(columns, row, "axis:method"), "\"NEE, two rays\"");
  EXPECT_EQ(field(columns, row, "seed"), "3");
  EXPECT_EQ(field(columns, row, "non_finite"), "3");
}

TEST(Records, FailedRunsHaveNoErrorsButAReason) {
  const auto columns = run_columns({});
  RunRecord row = run_record("a", 1, 0.5);
  row.status = RunStatus::failed;
  row.reason = "out of memory";
  EXPECT_EQ(field(columns, row, "relmse"), "");
  EXPECT_EQ(field(columns, row, "relmse_x_s"), "");
  EXPECT_EQ(field(columns, row, "reason"), "out of memory");
  EXPECT_EQ(field(columns, row, "frames"), "3");
}

TEST(Records, ConfigurationColumnsTakeFiguresOverTheSeeds) {
  const auto columns = configuration_columns({Axis{"method", false, {}}, Axis{"seed", true, {}}});
  expect_distinct(columns);
  const Configuration configuration =
      collect_configurations({run_record("RL", 1, 0.25), run_record("RL", 2, 0.75)}).front();
  EXPECT_EQ(field(columns, configuration, "axis:method"), "RL");
  EXPECT_EQ(field(columns, configuration, "axis:seed"), "no such column");
  EXPECT_EQ(field(columns, configuration, "seeds"), "2");
  EXPECT_EQ(field(columns, configuration, "relmse"), "0.5");
  EXPECT_NEAR(std::stod(field(columns, configuration, "relmse_sd")), std::sqrt(0.125), 1e-15);
  EXPECT_NEAR(std::stod(field(columns, configuration, "relmse_high")), 0.5 * std::exp(12.7062 * 0.25 / 0.5),
              0.05);
  EXPECT_NEAR(std::stod(field(columns, configuration, "clamp_bias_low")), -0.0625 - 12.7062 * 0.03125, 1e-5);
  EXPECT_EQ(field(columns, configuration, "flip"), "");
  const Configuration lonely = collect_configurations({run_record("RL", 1, 0.25)}).front();
  EXPECT_EQ(field(columns, lonely, "relmse"), "0.25");
  EXPECT_EQ(field(columns, lonely, "relmse_low"), "");
}

TEST(Records, ConfigurationsPoolFramesAndAverageErrors) {
  RunRecord failed = run_record("RL", 3, 0);
  failed.status = RunStatus::failed;
  const std::vector<Configuration> configurations = collect_configurations(
      {run_record("RL", 1, 0.25), run_record("NEE", 1, 1), run_record("RL", 2, 0.75), failed});
  ASSERT_EQ(configurations.size(), 2U);
  EXPECT_EQ(configurations[0].name, "RL");
  EXPECT_EQ(configurations[0].runs, 3U);
  EXPECT_EQ(configurations[0].finished, 2U);
  EXPECT_EQ(configurations[0].host_ms->median, 3);
  EXPECT_EQ(configurations[0].figure("relmse")->mean, 0.5);
  EXPECT_TRUE(configurations[0].figure("relmse")->low.has_value());
  EXPECT_NEAR(configurations[0].figure("relmse_x_s")->mean, 0.5 * 0.106, 1e-15);
  EXPECT_EQ(configurations[0].non_finite, 9U);
  EXPECT_EQ(configurations[0].clamped_samples, 45U);
  EXPECT_EQ(configurations[0].figure("fireflies_per_million")->mean, 200000);
  EXPECT_EQ(configurations[0].figure("fireflies_per_million")->sd, 0);
  EXPECT_EQ(configurations[0].figure("clamp_bias")->mean, -0.0625);
  EXPECT_FALSE(configurations[0].figure("filtered_relmse").has_value());
  EXPECT_FALSE(configurations[1].figure("relmse")->low.has_value());
}

}  // namespace
}  // namespace qtrace::experiments
