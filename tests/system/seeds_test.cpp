// Repetitions and baselines of a sweep, from end to end.
#include "tests/system/run_program.h"

#include <cmath>

namespace qtrace::tests {
namespace {

// Configurations take turns, seed by seed, whatever the order of the axes; files keep the order of the
// config.
TEST_F(RunProgram, ConfigurationsTakeTurnsAndTheOrderIsRecorded) {
  ASSERT_EQ(run("turns", kMethods).exit_code, 0);
  const auto summary = parse_csv(folder_.read("results/turns/summary.csv"));
  const std::vector<std::string> order{"1", "3", "2", "4"};  // NEE seed 1, 2, RL seed 1, 2
  const Json runs = json("results/turns/manifest.json").at("runs");
  for (std::size_t i = 0; i < order.size(); ++i) {
    EXPECT_EQ(summary.at(i).at("order"), order[i]);
    EXPECT_EQ(std::to_string(runs.at(i).at("order").get<int>()), order[i]);
    EXPECT_EQ(runs.at(i).at("run"), summary[i].at("run"));
    EXPECT_EQ(runs.at(i).at("started"), summary[i].at("started"));
  }
  EXPECT_LE(summary[2].at("started"), summary[1].at("started"));
}

TEST_F(RunProgram, ConfigurationsAndRatiosHaveIntervals) {
  const Outcome outcome = run("ratios", std::string(kMethods) + R"("baseline": "NEE, one ray", )");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto configurations = parse_csv(folder_.read("results/ratios/configurations.csv"));
  ASSERT_EQ(configurations.size(), 2U);
  const auto summary = parse_csv(folder_.read("results/ratios/summary.csv"));
  EXPECT_EQ(configurations[1].at("configuration"), "RL");
  EXPECT_EQ(configurations[1].at("seeds"), "2");
  EXPECT_NEAR(std::stod(configurations[1].at("mse")),
              (std::stod(summary[2].at("mse")) + std::stod(summary[3].at("mse"))) / 2, 1e-12);
  EXPECT_LT(std::stod(configurations[1].at("mse_low")), std::stod(configurations[1].at("mse")));
  EXPECT_GT(std::stod(configurations[1].at("mse_high")), std::stod(configurations[1].at("mse")));
  EXPECT_FALSE(configurations[1].at("slope_mse").empty());
  // E(mse) = variance + bias2 + reference noise holds for the means over seeds exactly.
  for (const auto& configuration : configurations) {
    EXPECT_NEAR(std::stod(configuration.at("mse")),
                std::stod(configuration.at("variance")) + std::stod(configuration.at("bias2")) +
                    std::stod(summary[0].at("reference_mse")),
                1e-6 * std::stod(configuration.at("mse")));
  }

  const auto ratios = parse_csv(folder_.read("results/ratios/ratios.csv"));
  ASSERT_EQ(ratios.size(), 1U);
  EXPECT_EQ(ratios[0].at("configuration"), "RL");
  EXPECT_EQ(ratios[0].at("baseline"), "NEE, one ray");
  EXPECT_NEAR(std::stod(ratios[0].at("ratio_mse")),
              std::stod(configurations[0].at("mse")) / std::stod(configurations[1].at("mse")), 1e-12);
  EXPECT_EQ(ratios[0].at("target_mse"), configurations[0].at("mse"));
  EXPECT_TRUE(contains(outcome.out, "time to the baseline's relMSE"));
}

// Many short runs tell a sampler that is biased from one that is noisy.
TEST_F(RunProgram, BiasIsToldFromVariance) {
  const Outcome outcome = run("bias", R"("sampler": "bsdf", "nee": "one_ray", "sweep": [
      {"samples": {"whole": {"reference.frames": 4096},
                   "clamped": {"reference.frames": 4096, "clamp_radiance": 0.3}}},
      {"seed": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]}], )");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto configurations = parse_csv(folder_.read("results/bias/configurations.csv"));
  ASSERT_EQ(configurations.size(), 2U);
  EXPECT_LE(std::stod(configurations[0].at("bias2_low")), 0) << "of whole samples";
  EXPECT_EQ(std::stod(configurations[0].at("abs_bias_low")), 0) << "of whole samples";
  EXPECT_GT(std::stod(configurations[1].at("abs_bias_low")), 0) << "of clamped samples";
  EXPECT_LT(std::stod(configurations[1].at("variance")), std::stod(configurations[0].at("variance")));
}

TEST_F(RunProgram, AnUnknownBaselineIsRefused) {
  const Outcome outcome = run("lost", std::string(kMethods) + R"("baseline": "NEE, one rai", )");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(
      contains(outcome.err,
               "key 'baseline' is 'NEE, one rai' but must be a label or a configuration of the sweep; "
               "did you mean 'NEE, one ray'?"))
      << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "results"));
}

}  // namespace
}  // namespace qtrace::tests
