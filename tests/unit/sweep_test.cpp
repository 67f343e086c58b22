// Axes, their product, and ids that stay what they are.
#include "engine/core/check.h"
#include "experiments/config/experiment_config.h"
#include "tests/support/cpu_time.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace qtrace::experiments {
namespace {

Experiment sweep(const std::string& axes, const std::string& extra = "") {
  const tests::TempFolder folder;
  const std::string text =
      "{\"name\": \"t\", \"scene\": \"s.glb\", \"frames\": 4, " + extra + "\"sweep\": " + axes + "}";
  return load_experiment(folder.write("c.json", text));
}

std::vector<std::string> ids(const std::string& axes) {
  std::vector<std::string> result;
  for (const Run& run : sweep(axes).runs) result.push_back(run.id);
  return result;
}

std::string error_of(const std::string& axes) {
  try {
    sweep(axes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool refused(const std::string& axes, const std::string& message) {
  const std::string error = error_of(axes);
  EXPECT_NE(error.find(message), std::string::npos) << error;
  return error != "no error";
}

TEST(Sweep, IsTheProductOfItsAxesLastFastest) {
  const Experiment experiment = sweep(R"([
      {"scene": ["x/simple.glb", "x/occluded.glb"]},
      {"method": {"NEE, two rays": {"sampler": "bsdf", "nee": "two_ray"},
                  "RL": {"sampler": "rl", "rl": {"update": "q_learning"}, "rl.bins_phi": 4}}},
      {"seed": [1, 2]}])");
  ASSERT_EQ(experiment.runs.size(), 8U);
  const auto& first = experiment.runs.front();
  EXPECT_EQ(first.id, "scene=simple,method=nee-two-rays,seed=1");
  EXPECT_EQ(first.configuration, "simple / NEE, two rays");
  EXPECT_EQ(first.labels, (std::vector<std::string>{"simple", "NEE, two rays", "1"}));
  EXPECT_EQ(first.config.render.nee, Nee::two_ray);
  EXPECT_EQ(experiment.runs[1].id, "scene=simple,method=nee-two-rays,seed=2");
  const auto& last = experiment.runs.back();
  EXPECT_EQ(last.id, "scene=occluded,method=rl,seed=2");
  EXPECT_EQ(last.config.scene, "x/occluded.glb");
  EXPECT_EQ(last.config.render.rl.update, UpdateRule::q_learning);
  EXPECT_EQ(last.config.render.rl.bins_phi, 4);
  EXPECT_EQ(last.config.render.rl.bins_theta, RlSettings{}.bins_theta);
  EXPECT_EQ(last.config.render.seed, 2U);
}

TEST(Sweep, IdsOfOldValuesStayWhenValuesAreAdded) {
  const std::vector<std::string> before = ids(R"([{"rl.sites_per_object": [10, 100]}, {"seed": [1]}])");
  const std::vector<std::string> after =
      ids(R"([{"rl.sites_per_object": [5, 10, 50, 100]}, {"seed": [7, 1]}])");
  for (const std::string& id : before) {
    EXPECT_NE(std::find(after.begin(), after.end(), id), after.end()) << id;
  }
  EXPECT_EQ(before.front(), "rl.sites_per_object=10,seed=1");
}

TEST(Sweep, NumbersKeepTheirTextInIds) {
  EXPECT_EQ(ids(R"([{"rl.cell_normal_threshold": [-1, 0.866, 1]}])"),
            (std::vector<std::string>{"rl.cell_normal_threshold=-1", "rl.cell_normal_threshold=0.866",
                                      "rl.cell_normal_threshold=1"}));
}

TEST(Sweep, GroupsMayBeEmptyAndOverrideNestedKeys) {
  const Experiment experiment =
      sweep(R"([{"m": {"base": {}, "short": {"reference.frames": 8, "reference": {"seed": 3}}}}])",
            R"("reference": {"frames": 32, "seed": 5}, )");
  EXPECT_EQ(experiment.runs[0].config.reference.frames, 32);
  EXPECT_EQ(experiment.runs[0].config.reference.seed, 5U);
  EXPECT_EQ(experiment.runs[1].config.reference.frames, 8);
  EXPECT_EQ(experiment.runs[1].config.reference.seed, 3U);
}

TEST(Sweep, RefusesAxesThatAreNone) {
  EXPECT_TRUE(refused("{}", "key 'sweep' is {} but must be a list of axes"));
  EXPECT_TRUE(refused("[3]", "'sweep[0]' is 3 but must be an object with one key"));
  EXPECT_TRUE(refused(R"([{"seed": [1], "nee": ["none"]}])", "must be an object with one key"));
  EXPECT_TRUE(refused(R"([{"seed": 1}])", "sweep axis 'seed' is 1 but must be"));
  EXPECT_TRUE(refused(R"([{"seed": []}])", "sweep axis 'seed' has no values"));
  EXPECT_TRUE(refused(R"([{"m": {"a": 3}}])", "group 'a' of sweep axis 'm' is 3 but must be an object"));
}

TEST(Sweep, RefusesUnknownKeys) {
  EXPECT_TRUE(refused(R"([{"sed": [1]}])", "unknown key 'sed'; did you mean 'seed'?"));
  EXPECT_TRUE(refused(R"([{"m": {"a": {"smapler": "rl"}}}])",
                      "group 'a' of sweep axis 'm' sets the unknown key 'smapler'; did you mean 'sampler'?"));
  EXPECT_TRUE(refused(R"([{"name": ["a", "b"]}])", "belongs to the whole experiment"));
}

TEST(Sweep, RefusesRunsThatCouldNotBeToldApart) {
  EXPECT_TRUE(refused(R"([{"seed": [1, 1]}])", "has the value 1 twice"));
  EXPECT_TRUE(refused(R"([{"width": [64, 64.0]}])", "has the value 64.0 twice"));
  EXPECT_TRUE(
      refused(R"([{"m": {"RL!": {}, "rl": {}}}])", "'RL!' and 'rl' would have the same folder name 'rl'"));
  EXPECT_TRUE(refused(R"([{"scene": ["a/s.glb", "b/s.glb"]}])", "would have the same folder name 's'"));
  EXPECT_TRUE(refused(R"([{"m": {"!!": {}}}])", "'!!' needs letters or digits"));
  EXPECT_TRUE(refused(R"([{"seed": [1]}, {"seed": [2]}])", "two sweep axes are called 'seed'"));
  EXPECT_TRUE(refused(R"([{"seed": [1]}, {"m": {"a": {"seed": 2}}}])", "both set 'seed'"));
  EXPECT_TRUE(
      refused(R"([{"rl.bins_phi": [1]}, {"m": {"a": {"rl": {"bins_phi": 2}}}}])", "both set 'rl.bins_phi'"));
}

TEST(Sweep, ErrorsNameTheRun) {
  EXPECT_TRUE(
      refused(R"([{"seed": [1, 9001]}])", "run 'seed=9001': keys 'seed' and 'reference.seed' are both 9001"));
  EXPECT_TRUE(refused(R"([{"width": [64, "wide"]}])", "run 'width=wide': key 'width' is \"wide\""));
  EXPECT_TRUE(refused(R"([{"m": {")" + std::string(220, 'x') + R"(": {}}}])", "an id of 222 bytes"));
}

// [first, first + 1, ...]
std::string numbers(int count, int first = 1) {
  std::string list;
  for (int i = 0; i < count; ++i) list += (i == 0 ? "" : ",") + std::to_string(first + i);
  return "[" + list + "]";
}

// The product of the first is 0 in 64 bits.
TEST(Sweep, TooManyRunsAreRefusedBeforeTheyAreMade) {
  const std::string message = "key 'sweep' asks for {} runs but 100000 are the most; divide it";
  std::string axes;
  for (const char* key : {"width", "height", "frames", "warmup_frames", "reference.frames", "rl.bins_phi",
                          "max_bounces", "reference.seed"}) {
    axes += fmt::format("{{\"{}\": {}}},", key, numbers(256));
  }
  EXPECT_TRUE(
      refused("[" + axes + "{\"seed\": [1]}]", fmt::format(fmt::runtime(message), "1.844674407e+19")));
  EXPECT_TRUE(refused("[{\"seed\": " + numbers(1000) + "}, {\"width\": " + numbers(1000) + "}]",
                      fmt::format(fmt::runtime(message), "1000000")));
  EXPECT_TRUE(refused("[{\"seed\": " + numbers(100'001, 10'000) + "}]",
                      fmt::format(fmt::runtime(message), "100001")));
}

// Found by fuzzing: 9 s, and 70 s under its sanitizers.
TEST(Sweep, TheMostRunsAreReadInSeconds) {
  const double start = test::cpu_seconds();
  const Experiment experiment =
      sweep("[{\"seed\": " + numbers(10'000, 10'000) + "}, {\"width\": " + numbers(10) + "}]",
            R"("baseline": "3", )");
  const double seconds = test::cpu_seconds() - start;
  EXPECT_EQ(experiment.runs.size(), 100'000U);
  EXPECT_EQ(experiment.runs.back().config.render.seed, 19'999U);
  EXPECT_EQ(experiment.runs.back().config.render.width, 10);
  EXPECT_LT(seconds, 4);
}

// Found by fuzzing: a long list in the base, a hundred thousand times.
TEST(Sweep, RunsThatFillTheMemoryAreRefused) {
  const std::string snapshots = "\"frames\": 100000, \"snapshots\": " + numbers(50'000) + ", ";
  const std::string text = "{\"name\": \"t\", \"scene\": \"s.glb\", " + snapshots +
                           "\"sweep\": [{\"seed\": " + numbers(1000) + "}]}";
  const std::string message = "key 'sweep' asks for 1000 runs with configs of up to 288";
  try {
    parse_experiment(text, "c.json");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST(Sweep, TooManyAxesAreRefused) {
  std::string axes;
  for (int i = 0; i < 60; ++i) axes += fmt::format("{}{{\"m{}\": {{\"a\": {{}}}}}}", i == 0 ? "" : ",", i);
  EXPECT_TRUE(refused("[" + axes + "]", "key 'sweep' has 60 axes but 50 are the most"));
}

// Found by fuzzing: each with a suggestion out of all configurations.
TEST(Sweep, ManyPublishedFiguresOfUnknownConfigurationsAreCounted) {
  std::string figures;
  for (int i = 0; i < 2000; ++i) figures += fmt::format("{}\"zz{}\": 1", i == 0 ? "" : ",", i);
  const Experiment experiment =
      sweep("[{\"width\": " + numbers(2000) + "}]", "\"published\": {\"ms_per_frame\": {" + figures + "}}, ");
  ASSERT_EQ(experiment.warnings.size(), 11U);
  EXPECT_NE(experiment.warnings[10].find("'published' names 1990 more"), std::string::npos)
      << experiment.warnings[10];
}

TEST(Sweep, SlugsAreSafeFileNames) {
  EXPECT_EQ(slug("RL + NEE, one ray"), "rl-nee-one-ray");
  EXPECT_EQ(slug("../etc/passwd"), "etc-passwd");
  EXPECT_EQ(slug("a_b.c"), "a_b.c");
  EXPECT_EQ(slug("é"), "");
}

TEST(Sweep, PublishedFiguresOfUnknownConfigurationsAreWarnedOf) {
  const Experiment experiment =
      sweep(R"([{"m": {"RL": {}, "NEE": {"sampler": "bsdf"}}}])",
            R"("published": {"ms_per_frame": {"RL": 3, "NE": 4}, "ratio": ["NEE", "RL"]}, )");
  ASSERT_EQ(experiment.warnings.size(), 1U);
  EXPECT_NE(experiment.warnings[0].find("'NE', which the sweep does not have; did you mean 'NEE'?"),
            std::string::npos);
  EXPECT_EQ(*experiment.published.ms_per_frame.find("RL"), 3);
  EXPECT_EQ(experiment.published.ms_per_frame.find("none"), nullptr);
}

TEST(Sweep, TheBaselineIsALabelOfOneAxisOrAConfiguration) {
  const std::string axes =
      R"([{"m": {"RL": {}, "NEE": {"sampler": "bsdf"}}}, {"frames": [2, 4]}, {"max_bounces": [4, 5]}])";
  EXPECT_EQ(sweep(axes, R"("baseline": "NEE", )").baseline, "NEE");
  EXPECT_EQ(sweep(axes, R"("baseline": "NEE / 4 / 5", )").baseline, "NEE / 4 / 5");
  EXPECT_THROW(sweep(axes, R"("baseline": "4", )"), Error);  // of frames or of bounces
  EXPECT_THROW(sweep(axes, R"("baseline": "NE", )"), Error);
}

}  // namespace
}  // namespace qtrace::experiments
