// Which configurations a baseline is compared with, and by how much.
#include "experiments/records/ratios.h"
#include "experiments/records/summary_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

namespace qtrace::experiments {
namespace {

// Three snapshots, `seconds` a frame, error `scale` / spp, a little more with every seed.
RunRecord record(const std::string& scene, const std::string& method, const std::string& sites, int seed,
                 double seconds, double scale) {
  RunRecord result;
  result.run.id = scene + method + sites + std::to_string(seed);
  result.run.configuration = scene + " / " + method + " / " + sites;
  result.run.labels = {scene, method, sites, std::to_string(seed)};
  result.scene = scene;
  result.status = RunStatus::finished;
  for (int frame = 1; frame <= 4; ++frame) {
    FrameRecord next;
    next.frame = frame;
    next.host_ms = seconds * 1e3;
    next.elapsed_s = seconds * frame;
    next.counters.rays = 100;
    result.frames.push_back(next);
    if (frame == 3) continue;
    SnapshotRecord snapshot;
    snapshot.frame = frame;
    snapshot.elapsed_s = next.elapsed_s;
    snapshot.errors.mse = snapshot.errors.relmse = scale * (1 + 0.01 * seed) / frame;
    snapshot.errors.relmse_trimmed = snapshot.errors.relmse / 2;
    snapshot.errors.reference = ReferenceNoise{};  // none
    result.snapshots.push_back(snapshot);
  }
  return result;
}

std::vector<RunRecord> records() {
  std::vector<RunRecord> all;
  for (const std::string scene : {"a", "b"}) {
    for (const int seed : {1, 2, 3}) {
      all.push_back(record(scene, "NEE", "10", seed, 2, 8));
      all.push_back(record(scene, "NEE", "20", seed, 2, 8));
      all.push_back(record(scene, "RL", "10", seed, 1, 4));
      all.push_back(record(scene, "RL", "20", seed, 4, 80));
    }
  }
  return all;
}

Experiment experiment(const std::string& baseline) {
  Experiment result;
  result.name = "demo";
  result.axes = {Axis{"scene", false, {}}, Axis{"method", false, {}}, Axis{"sites", false, {}},
                 Axis{"seed", true, {}}};
  result.baseline = baseline;
  return result;
}

std::vector<std::string> pairs(const std::vector<Ratios>& ratios) {
  std::vector<std::string> names;
  for (const Ratios& row : ratios) names.push_back(row.configuration + " to " + row.baseline);
  return names;
}

TEST(Baseline, ALabelIsTheBaselineOfConfigurationsThatDifferInItAlone) {
  const std::vector<RunRecord> all = records();
  EXPECT_EQ(pairs(baseline_ratios(experiment("NEE"), collect_configurations(all))),
            (std::vector<std::string>{"a / RL / 10 to a / NEE / 10", "a / RL / 20 to a / NEE / 20",
                                      "b / RL / 10 to b / NEE / 10", "b / RL / 20 to b / NEE / 20"}));
}

TEST(Baseline, AConfigurationIsTheBaselineOfItsNeighbours) {
  const std::vector<RunRecord> all = records();
  EXPECT_EQ(pairs(baseline_ratios(experiment("a / NEE / 10"), collect_configurations(all))),
            (std::vector<std::string>{"a / NEE / 20 to a / NEE / 10", "a / RL / 10 to a / NEE / 10"}));
  EXPECT_TRUE(baseline_ratios(experiment(""), collect_configurations(all)).empty());
}

// RL with ten sites has half the error and half the seconds per frame: it reaches the error of four frames of
// NEE after two frames, in a quarter of the time. With twenty sites it never does.
TEST(Baseline, RatiosAreTheBaselinesFigureOverTheConfigurations) {
  const std::vector<RunRecord> all = records();
  const std::vector<Ratios> ratios = baseline_ratios(experiment("NEE"), collect_configurations(all));
  const Ratios& fast = ratios.at(0);
  EXPECT_NEAR(fast.figures.at("host_ms_median").value, 2, 1e-12);
  EXPECT_NEAR(*fast.figures.at("host_ms_median").low, 2, 1e-12);  // no scatter
  EXPECT_NEAR(fast.figures.at("relmse").value, 2, 1e-12);
  EXPECT_NEAR(fast.figures.at("relmse_trimmed").value, 2, 1e-12);
  EXPECT_NEAR(fast.figures.at("relmse_x_s").value, 4, 1e-12);
  EXPECT_LT(*fast.figures.at("relmse").low, 2);
  EXPECT_NEAR(*fast.times.at("mse").target, 8 * 1.02 / 4, 1e-12);
  EXPECT_NEAR(fast.times.at("mse").time->value, 2, 1e-12);
  EXPECT_NEAR(fast.times.at("relmse").ratio->value, 4, 1e-12);
  EXPECT_LT(*fast.times.at("relmse").ratio->low, 4);
  EXPECT_GT(*fast.times.at("relmse").ratio->high, 4);
  // NEE after half of its seconds, which are all of RL's: two of its frames.
  EXPECT_NEAR(fast.equal_seconds.at("mse_corrected")->value, 4, 1e-12);
  EXPECT_LT(*fast.equal_seconds.at("mse_corrected")->low, 4);
  EXPECT_GT(*fast.equal_seconds.at("mse_corrected")->high, 4);
  EXPECT_FALSE(ratios.at(1).times.at("relmse").ratio.has_value());
  EXPECT_FALSE(ratios.at(1).times.at("relmse").time.has_value());
}

// Runs of NEE and RL, `seeds` of each. A machine that drifts makes all runs of a seed slower by the same
// factor.
std::vector<RunRecord> timed_records(int seeds, double drift, std::mt19937_64& random) {
  std::lognormal_distribution<double> slower(0, drift);
  std::lognormal_distribution<double> own(0, 0.03);
  std::vector<RunRecord> all;
  for (int seed = 1; seed <= seeds; ++seed) {
    const double machine = slower(random);
    for (const auto& [method, seconds, error] : {std::tuple("NEE", 2.0, 8.0), std::tuple("RL", 1.0, 4.0)}) {
      all.push_back(record("a", method, "10", 0, seconds * machine * own(random), error * own(random)));
      all.back().run.config.render.seed = static_cast<std::uint32_t>(seed);
    }
  }
  return all;
}

struct Coverage {
  double share = 0;      // of the intervals, those that hold the true ratio, which is 4
  double log_width = 0;  // their mean
};

Coverage coverage_at_equal_seconds(int seeds, double drift) {
  constexpr int kGroups = 1000;
  std::mt19937_64 random(5);
  Coverage result;
  for (int group = 0; group < kGroups; ++group) {
    const std::vector<RunRecord> all = timed_records(seeds, drift, random);
    const Interval found = *baseline_ratios(experiment("NEE"), collect_configurations(all))
                                .at(0)
                                .equal_seconds.at("mse_corrected");
    result.share += (*found.low <= 4 && 4 <= *found.high ? 1.0 : 0.0) / kGroups;
    result.log_width += std::log(*found.high / *found.low) / kGroups;
  }
  return result;
}

// The share has a standard error of 0.7 %. Seeds that are compared in pairs do not see what slows both; four
// are not yet.
TEST(Baseline, IntervalsAtEqualSecondsHoldWhatTheyPromise) {
  for (const double drift : {0.0, 0.2}) {
    const Coverage paired = coverage_at_equal_seconds(5, drift);
    EXPECT_GE(paired.share, 0.925) << drift;
    EXPECT_LE(paired.share, 0.975) << drift;
  }
  EXPECT_LT(coverage_at_equal_seconds(5, 0.2).log_width, coverage_at_equal_seconds(4, 0.2).log_width / 3);
}

TEST(Baseline, OtherSeedsAreNotPaired) {
  std::mt19937_64 random(6);
  std::vector<RunRecord> all = timed_records(5, 0.2, random);
  const auto width = [&] {
    const Interval found = *baseline_ratios(experiment("NEE"), collect_configurations(all))
                                .at(0)
                                .equal_seconds.at("mse_corrected");
    return *found.high / *found.low;
  };
  const double paired = width();
  for (RunRecord& run : all) run.run.config.render.seed += run.run.labels[1] == "RL" ? 10U : 0U;
  EXPECT_GT(width(), 1.1 * paired);
}

TEST(Baseline, ThePageSaysWhoseTableWasGivenUp) {
  std::vector<RunRecord> all = records();
  EXPECT_EQ(experiment_table(experiment(""), all, {}, "d").find("Tables given up"), std::string::npos);
  for (RunRecord& run : all) {
    if (run.run.configuration == "a / RL / 10") run.table_given_up = 0;
    if (run.run.id == "bRL202") run.table_given_up = 32;
    if (run.run.configuration == "b / NEE / 10") run.light_paths_given_up = true;
  }
  const std::string table = experiment_table(experiment(""), all, {}, "d");
  EXPECT_NE(table.find("- a / RL / 10: given up by 3 of 3 runs\n"), std::string::npos) << table;
  EXPECT_NE(table.find("- b / RL / 20: given up by 1 of 3 runs; the others kept it"), std::string::npos)
      << table;
  EXPECT_NE(table.find("Light paths given up after their trial (light_path_trial):\n- b / NEE / 10: given up "
                       "by 3 of 3 runs"),
            std::string::npos)
      << table;
}

TEST(Baseline, TheTableWarnsOfSlopesThatAreNotMinusOne) {
  std::vector<RunRecord> all = records();
  for (RunRecord& run : all) run.run.config.render.random = RandomNumbers::independent;
  EXPECT_EQ(experiment_table(experiment(""), all, {}, "d").find("do not fall"), std::string::npos);
  for (RunRecord& run : all) {
    if (run.run.labels[1] == "RL") run.snapshots.back().errors.mse *= run.run.labels[2] == "10" ? 2 : 0.25;
  }
  const std::string table = experiment_table(experiment(""), all, {}, "d");
  EXPECT_NE(table.find("- a / RL / 10: slope_mse against spp -0.5 [-0.5, -0.5]: flatter"), std::string::npos)
      << table;
  EXPECT_NE(table.find("- b / RL / 20: slope_mse against spp -2 [-2, -2]: steeper"), std::string::npos)
      << table;
  EXPECT_EQ(table.find("NEE / 10: slope"), std::string::npos);
  // Steep is what Sobol' points are for; flat they should not be, either.
  for (RunRecord& run : all) run.run.config.render.random = RandomNumbers::sobol;
  const std::string of_sobol = experiment_table(experiment(""), all, {}, "d");
  EXPECT_NE(of_sobol.find("flatter"), std::string::npos) << of_sobol;
  EXPECT_EQ(of_sobol.find("steeper"), std::string::npos) << of_sobol;
}

}  // namespace
}  // namespace qtrace::experiments
