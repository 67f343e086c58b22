// Planning a night, looking at it, and doing a run of it again.
#include "tests/system/run_program.h"

#include <fmt/format.h>

#include <filesystem>

namespace qtrace::tests {
namespace {

namespace fs = std::filesystem;

class Night : public RunProgram {
 protected:
  void write_config(const std::string& name, int frames) const {
    folder_.write(name + ".json", fmt::format(R"({{
      "name": "{}", "scene": "scene.gltf", "width": 32, "height": 32, "frames": {}, "max_bounces": 3,
      "save_table": "last", "reference": {{"frames": 8}},
      "sweep": [{{"method": {{"NEE": {{"sampler": "bsdf", "nee": "one_ray"}}, "RL": {{"sampler": "rl"}}}}}},
                {{"seed": [1, 2]}}]}})",
                                              name, frames));
  }
  Outcome qtrace(const std::vector<std::string>& arguments) const {
    return run_qtrace(arguments, folder_.path());
  }
};

TEST_F(Night, WhenTimeIsUpEveryConfigurationHasAsMuchAsTheOthers) {
  write_config("budget", 200'000);  // minutes
  const Outcome outcome = qtrace({"run", "budget.json", "--time-budget", "4s"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "the time budget is used up")) << outcome.err;
  const auto rows = parse_csv(folder_.read("results/budget/summary.csv"));
  ASSERT_EQ(rows.size(), 2U) << outcome.err;  // the first seed of each configuration
  for (const auto& row : rows) {
    EXPECT_EQ(row.at("status"), "partial");
    EXPECT_NE(row.at("relmse"), "");
  }
  const double ratio = std::stod(rows[0].at("frames")) / std::stod(rows[1].at("frames"));
  EXPECT_GE(ratio, 0.25);
  EXPECT_LE(ratio, 4);
  EXPECT_TRUE(contains(outcome.out, " of 200000 ")) << outcome.out;
  EXPECT_TRUE(
      contains(qtrace({"run", "budget.json", "--time-budget", "soon"}).err, "must be a time such as 8h"));
}

TEST_F(Night, ADryRunTellsWhatIsThereAndWhatIsLeftAndWritesNothing) {
  write_config("plan", 64);
  const Outcome before = qtrace({"run", "plan.json", "--dry-run"});
  EXPECT_EQ(before.exit_code, 0) << before.err;
  EXPECT_TRUE(contains(before.out, "plan: 4 runs, 4 to do")) << before.out;
  EXPECT_TRUE(contains(before.out, "measured on all 2 configurations")) << before.out;
  EXPECT_TRUE(contains(before.out, "disk: at most ")) << before.out;
  EXPECT_FALSE(fs::exists(folder_ / "results"));
  qtrace({"run", "plan.json", "--only", "*seed=1"});
  const auto tree_before = tree(folder_ / "results");
  const Outcome half = qtrace({"run", "plan.json", "--dry-run"});
  EXPECT_TRUE(contains(half.out, "plan: 4 runs, 2 to do")) << half.out;
  EXPECT_TRUE(contains(half.out, "finished")) << half.out;
  EXPECT_EQ(tree_before, tree(folder_ / "results"));
}

TEST_F(Night, StatusTellsFromAnotherShell) {
  write_config("busy", 200'000);
  Outcome during;
  const auto look = [&] {
    const std::string report = "results/busy/.progress.json";
    if (!fs::exists(folder_ / report) || !contains(folder_.read(report), "run 1/4")) return false;
    during = qtrace({"status", "results"});
    return true;
  };
  ASSERT_TRUE(kill_qtrace_when({"run", "busy.json"}, folder_.path(), look));
  EXPECT_TRUE(contains(during.out, "busy: at work: process ")) << during.out;
  EXPECT_TRUE(contains(during.out, "now: run 1/4 method=nee,seed=1: frame ")) << during.out;
  EXPECT_TRUE(contains(during.out, "0 of 4 runs finished, 1 running, 3 waiting")) << during.out;
  const Outcome after = qtrace({"status", "results/busy"});
  EXPECT_TRUE(contains(after.out, "nobody is at work")) << after.out;
  EXPECT_TRUE(contains(after.out, "1 cut off")) << after.out;
  EXPECT_EQ(qtrace({"status", "nowhere"}).exit_code, 1);
  EXPECT_TRUE(contains(folder_.read("results/busy/log.txt"), "reference of scene: 16 frames rendered"));
}

TEST_F(Night, ARunDoneAgainHasTheSameBitsOrSaysWhatDiffers) {
  write_config("first", 16);
  ASSERT_EQ(qtrace({"run", "first.json"}).exit_code, 0);
  const std::string run = "results/first/method=rl,seed=2/";
  const auto before = tree(folder_.path());
  const Outcome same = qtrace({"rerun", run + "manifest.json"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  // Snapshots after 1, 2, 4, 8 and 16 frames, the first hits, and three tables.
  EXPECT_TRUE(contains(same.out, "the bits agree in all 9 images and tables")) << same.out;
  EXPECT_TRUE(contains(same.out, "the program and the device are the same")) << same.out;
  EXPECT_EQ(before, tree(folder_.path()));  // nothing is left behind
  // Another seed's image in its place.
  folder_.write(run + "frame_000016.exr", folder_.read("results/first/method=rl,seed=1/frame_000016.exr"));
  Json manifest = json(run + "manifest.json");
  manifest["program"]["commit"] = "older";
  folder_.write(run + "manifest.json", manifest.dump());
  const Outcome other = qtrace({"rerun", run + "manifest.json", "--out", "kept"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_TRUE(contains(other.out, "frame_000016.exr: ")) << other.out;
  EXPECT_TRUE(contains(other.out, " of 1024 pixels differ, the first at (")) << other.out;
  EXPECT_FALSE(contains(other.out, "frame_000008.exr")) << other.out;
  EXPECT_TRUE(contains(other.out, "program commit: was \"older\", is ")) << other.out;
  EXPECT_TRUE(fs::exists(folder_ / "kept/first/method=rl,seed=2/frame_000016.exr"));
  EXPECT_TRUE(
      contains(qtrace({"rerun", "results/first/manifest.json"}).err, "so it is no manifest of a run"));
  write_small_scene(folder_, "scene", Light::off);
  EXPECT_TRUE(contains(qtrace({"rerun", run + "manifest.json"}).err, "is not what was rendered then"));
}

}  // namespace
}  // namespace qtrace::tests
