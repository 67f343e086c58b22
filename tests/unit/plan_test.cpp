#include "experiments/study/plan.h"

#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <set>

namespace qtrace::experiments {
namespace {

// Configurations a, b, c with two seeds each.
Experiment six_runs(int frames = 64) {
  Experiment experiment;
  experiment.file = "x.json";
  for (const char* configuration : {"a", "b", "c"}) {
    for (const char* seed : {"1", "2"}) {
      Run run;
      run.configuration = configuration;
      run.id = run.configuration + ",seed=" + seed;
      run.config.frames = frames;
      experiment.runs.push_back(run);
    }
  }
  return experiment;
}

RunChoices of_shard(const Shard& shard) {
  RunChoices choices;
  choices.shard = shard;
  return choices;
}

RunChoices fitting(const std::string& pattern) {
  RunChoices choices;
  choices.only = pattern;
  return choices;
}

std::string text(const Experiment& experiment, const std::vector<Step>& steps) {
  std::string all;
  for (const Step& step : steps) {
    const Run& run = experiment.runs[step.turn.place];
    all +=
        run.configuration + std::to_string(step.turn.repetition + 1) + ":" + std::to_string(step.until) + " ";
  }
  return all;
}

TEST(Plan, EverySeedOfAllConfigurationsBeforeTheNext) {
  const Experiment experiment = six_runs();
  const auto turns = chosen_turns(experiment, {});
  EXPECT_EQ(text(experiment, steps_of(experiment, turns, 1)), "a1:64 b1:64 c1:64 a2:64 b2:64 c2:64 ");
  EXPECT_EQ(turns[3].order, 4);
}

TEST(Plan, InRoundsTheConfigurationsGrowTogether) {
  const Experiment experiment = six_runs();
  const auto turns = chosen_turns(experiment, {});
  EXPECT_EQ(text(experiment, steps_of(experiment, turns, 3)),
            "a1:16 b1:16 c1:16 a1:32 b1:32 c1:32 a1:64 b1:64 c1:64 a2:64 b2:64 c2:64 ");
  // Rounds that end at the same snapshot are one.
  Experiment few = six_runs(64);
  for (experiments::Run& run : few.runs) run.config.snapshots = {false, {48}};
  EXPECT_EQ(text(few, steps_of(few, turns, 4)), "a1:48 b1:48 c1:48 a1:64 b1:64 c1:64 a2:64 b2:64 c2:64 ");
}

TEST(Plan, TheFirstRoundTakesATenthOfTheTime) {
  EXPECT_EQ(rounds_for(1, 10), 1);
  EXPECT_EQ(rounds_for(1.01, 10), 2);
  EXPECT_EQ(rounds_for(80, 10), 8);  // 80 / 2^7 < 1
  EXPECT_EQ(rounds_for(1e12, 1), kMostRounds);
}

TEST(Plan, ShardsHaveEveryRunOnceAndAboutAsMany) {
  const Experiment experiment = six_runs();
  std::set<std::size_t> places;
  for (std::size_t i = 1; i <= 4; ++i) {
    const auto turns = chosen_turns(experiment, of_shard({i, 4}));
    EXPECT_TRUE(turns.size() == 1 || turns.size() == 2);
    for (const Turn& turn : turns) EXPECT_TRUE(places.insert(turn.place).second);
  }
  EXPECT_EQ(places.size(), 6U);
}

TEST(Plan, PatternsChooseByName) {
  const Experiment experiment = six_runs();
  EXPECT_EQ(chosen_turns(experiment, fitting("b,*")).size(), 2U);
  EXPECT_EQ(chosen_turns(experiment, fitting("?,seed=2")).size(), 3U);
  EXPECT_THROW(chosen_turns(experiment, fitting("d*")), Error);
}

}  // namespace
}  // namespace qtrace::experiments
