// A sweep that is killed, stopped or changed, and what the same command then does.
#include "tests/system/run_program.h"

#include <csignal>
#include <filesystem>

namespace qtrace::tests {
namespace {

namespace fs = std::filesystem;

// RL and not, two seeds each, long enough to be interrupted: half a second a run. State is kept all the time;
// a small table keeps it small, for its writing would take most of the time.
constexpr const char* kSweep = R"({
  "name": "NAME", "scene": "scene.gltf", "width": 32, "height": 32, "frames": 400, "max_bounces": 3,
  "checkpoint_s": 0.01, "save_table": "last", "snapshots": [16, 64], "reference": {"frames": 8},
  "rl": {"sites_per_object": 10},
  "sweep": [{"method": {"NEE": {"sampler": "bsdf", "nee": "one_ray"}, "RL": {"sampler": "rl"}}}, {"seed": [1, 2]}]
})";

// The files of finished runs whose content is the same whatever happened on the way.
std::vector<std::string> final_files(const fs::path& folder) {
  std::vector<std::string> files;
  for (const std::string& name : tree(folder)) {
    if (name.ends_with(".exr") || name.ends_with(".npy")) files.push_back(name);
  }
  return files;
}

// Whether a column of any file holds a time, or what follows from times or from the experiment's name.
bool is_time(const std::string& column) {
  return column.starts_with("host_ms") || column.starts_with("gpu_ms") || column == "filter_ms" ||
         column.ends_with("_s") || column == "started" || column == "noisy" || column == "warmup_detected" ||
         column == "config_hash";
}

class Resume : public RunProgram {
 protected:
  void write_config(const std::string& name) const {
    std::string text = kSweep;
    folder_.write(name + ".json", text.replace(text.find("NAME"), 4, name));
  }

  // All images and tables, and every column that holds no time.
  void expect_same_results(const std::string& a, const std::string& b) const {
    const auto files = final_files(folder_ / ("results/" + a));
    EXPECT_EQ(files, final_files(folder_ / ("results/" + b)));
    EXPECT_EQ(files.size(), 4U * 4 + 2 * 3);
    for (const std::string& file : files) {
      EXPECT_TRUE(folder_.read("results/" + a + "/" + file) == folder_.read("results/" + b + "/" + file))
          << file;
    }
    EXPECT_EQ(parse_csv(folder_.read("results/" + a + "/summary.csv")).size(), 4U);
    expect_same_rows("results/" + a, "results/" + b, "summary.csv");
    for (const char* run : {"method=nee,seed=1", "method=rl,seed=2"}) {
      const std::string place = std::string("/") + run;
      expect_same_rows("results/" + a + place, "results/" + b + place, "frames.csv");
      expect_same_rows("results/" + a + place, "results/" + b + place, "convergence.csv");
    }
  }

  void expect_same_rows(const std::string& a, const std::string& b, const std::string& file) const {
    const auto one = parse_csv(folder_.read(a + "/" + file));
    const auto two = parse_csv(folder_.read(b + "/" + file));
    ASSERT_EQ(one.size(), two.size()) << file;
    ASSERT_GE(one.size(), 3U) << file;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
      for (const auto& [column, value] : one[i]) {
        if (is_time(column)) continue;
        EXPECT_EQ(value, two[i].at(column)) << file << " " << i << " " << column;
        ++compared;
      }
    }
    EXPECT_GE(compared, 13 * one.size()) << file;  // of frames.csv, which has the fewest
  }

  Outcome again(const std::string& name, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"run", name + ".json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_qtrace(arguments, folder_.path());
  }
};

TEST_F(Resume, AKilledSweepEndsWithTheSameBits) {
  write_config("whole");
  ASSERT_EQ(again("whole").exit_code, 0);
  write_config("killed");
  const fs::path run = folder_ / "results/killed/method=rl,seed=1";
  const auto has_checkpoint = [&] { return fs::exists(run / "checkpoint.state"); };
  ASSERT_TRUE(kill_qtrace_when({"run", "killed.json"}, folder_.path(), has_checkpoint));
  EXPECT_EQ(json("results/killed/method=rl,seed=1/manifest.json").at("status"), "running");
  const Outcome outcome = again("killed");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "1 of 4 runs are there already")) << outcome.err;
  EXPECT_GT(json("results/killed/method=rl,seed=1/manifest.json").at("resumed_after_frame"), 0);
  EXPECT_FALSE(has_checkpoint());
  expect_same_results("whole", "killed");
}

TEST_F(Resume, AFinishedSweepIsNotDoneAgain) {
  write_config("done");
  ASSERT_EQ(again("done").exit_code, 0);
  const auto time = fs::last_write_time(folder_ / "results/done/method=rl,seed=2/frame_000400.exr");
  const std::string summary = folder_.read("results/done/summary.csv");
  const Outcome outcome = again("done");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(contains(outcome.err, "4 of 4 runs are there already")) << outcome.err;
  EXPECT_EQ(time, fs::last_write_time(folder_ / "results/done/method=rl,seed=2/frame_000400.exr"));
  EXPECT_EQ(summary, folder_.read("results/done/summary.csv"));  // to the bit, with its times
}

// A process that ends between a run's last manifest and the removal of its state.
TEST_F(Resume, StatesOfFinishedRunsAreClearedAway) {
  write_config("cleared");
  ASSERT_EQ(again("cleared").exit_code, 0);
  const auto states = [&] {
    std::vector<std::string> found;
    for (const std::string& name : tree(folder_ / "results/cleared")) {
      if (name.ends_with("checkpoint.state")) found.push_back(name);
    }
    return found;
  };
  EXPECT_EQ(states(), std::vector<std::string>{});
  folder_.write("results/cleared/method=rl,seed=2/checkpoint.state", "left behind");
  EXPECT_EQ(again("cleared").exit_code, 0);
  EXPECT_EQ(states(), std::vector<std::string>{});
}

TEST_F(Resume, SignalsEndAfterTheFrameAndTheSweepGoesOn) {
  write_config("whole");
  ASSERT_EQ(again("whole").exit_code, 0);
  for (const auto& [signal, exit_code] : {std::pair(SIGINT, 130), std::pair(SIGTERM, 143)}) {
    const std::string name = "signal" + std::to_string(signal);
    write_config(name);
    const fs::path run = folder_ / ("results/" + name + "/method=rl,seed=1");
    const auto stopped = signal_qtrace_when(signal, {"run", name + ".json"}, folder_.path(),
                                            [&] { return fs::exists(run / "checkpoint.state"); });
    ASSERT_TRUE(stopped.has_value());
    EXPECT_EQ(stopped->exit_code, exit_code) << stopped->err;
    EXPECT_TRUE(contains(stopped->err, "the same command goes on")) << stopped->err;
    EXPECT_EQ(json("results/" + name + "/manifest.json").at("status"), "partial");
    const auto rows = parse_csv(folder_.read("results/" + name + "/summary.csv"));
    ASSERT_EQ(rows.size(), 2U);  // the first seed of the first method, and this one
    EXPECT_EQ(rows[0].at("status"), "finished");
    EXPECT_EQ(rows[1].at("status"), "partial");
    const int frames = std::stoi(rows[1].at("frames"));
    EXPECT_TRUE(frames == 16 || frames == 64 || rows[1].at("relmse").empty()) << frames;  // up to a snapshot
    ASSERT_EQ(again(name).exit_code, 0);
    expect_same_results("whole", name);
  }
}

TEST_F(Resume, ChangedConfigsScenesAndProgramsAreNotMixed) {
  write_config("changed");
  ASSERT_EQ(again("changed").exit_code, 0);
  const std::string before = folder_.read("results/changed/summary.csv");
  const Outcome longer = again("changed", {"--set", "frames=64", "--set", "max_bounces=2"});
  EXPECT_EQ(longer.exit_code, 1);
  EXPECT_TRUE(contains(longer.err, "key 'frames' was 400 and is 64")) << longer.err;
  EXPECT_TRUE(contains(longer.err, "--fresh")) << longer.err;
  EXPECT_TRUE(contains(longer.err, "--out")) << longer.err;
  EXPECT_EQ(before, folder_.read("results/changed/summary.csv"));
  EXPECT_EQ(again("changed", {"--set", "checkpoint_s=5"}).exit_code, 0);  // changes no result
  write_small_scene(folder_, "scene", Light::off);
  const Outcome dark = again("changed");
  EXPECT_EQ(dark.exit_code, 1);
  EXPECT_TRUE(contains(dark.err, "the content of scene 'scene.gltf' has changed")) << dark.err;
  write_small_scene(folder_, "scene");
  Json manifest = json("results/changed/manifest.json");
  manifest["program"]["binary"] = "another";
  folder_.write("results/changed/manifest.json", manifest.dump());
  const Outcome other = again("changed");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_TRUE(contains(other.err, "the program's 'binary' was \"another\" and is")) << other.err;
}

TEST_F(Resume, ASecondProcessIsRefused) {
  write_config("busy");
  const fs::path run = folder_ / "results/busy/method=rl,seed=2";
  Outcome second;
  const auto meanwhile = [&] {
    if (!fs::exists(folder_ / "results/busy/manifest.json")) return false;
    second = again("busy");
    return true;
  };
  ASSERT_TRUE(kill_qtrace_when({"run", "busy.json"}, folder_.path(), meanwhile));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_TRUE(contains(second.err, "results/busy: another qtrace (process ")) << second.err;
  EXPECT_EQ(again("busy").exit_code, 0);  // the lock ended with its process
}

TEST_F(Resume, DamagedFilesAreNamedAndDoneAgain) {
  write_config("whole");
  ASSERT_EQ(again("whole").exit_code, 0);
  fs::copy(folder_ / "results/whole", folder_ / "results/damaged", fs::copy_options::recursive);
  write_config("damaged");
  folder_.write("results/damaged/manifest.json", folder_.read("results/whole/manifest.json"));
  Json manifest = json("results/damaged/manifest.json");
  manifest["config"]["name"] = "damaged";
  folder_.write("results/damaged/manifest.json", manifest.dump());
  const std::string record = "results/damaged/method=rl,seed=1/record.state";
  folder_.write(record, folder_.read(record).substr(0, 200));
  const Outcome outcome = again("damaged");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "record.state")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "3 of 4 runs are there already")) << outcome.err;
  expect_same_results("whole", "damaged");
}

TEST_F(Resume, ShardsAndTheirMergeAreTheWhole) {
  write_config("whole");
  ASSERT_EQ(again("whole").exit_code, 0);
  write_config("shards");
  EXPECT_EQ(again("shards", {"--references-only"}).exit_code, 0);
  EXPECT_EQ(final_files(folder_ / "results/shards").size(), 0U);
  EXPECT_EQ(again("shards", {"--shard", "1/3"}).exit_code, 0);
  const Outcome early = again("shards", {"--merge"});
  EXPECT_EQ(early.exit_code, 1);  // two runs are missing
  EXPECT_TRUE(contains(early.out, "2 not begun, of 4")) << early.out;
  EXPECT_EQ(again("shards", {"--shard", "2/3"}).exit_code, 0);
  EXPECT_EQ(again("shards", {"--shard", "3/3"}).exit_code, 0);
  EXPECT_EQ(again("shards", {"--merge"}).exit_code, 0);
  expect_same_results("whole", "shards");
  EXPECT_TRUE(contains(again("shards", {"--shard", "4/3"}).err, "--shard 4/3: must be i/n")) << "bad shard";
}

TEST_F(Resume, OnlyTheRunsThatFitThePattern) {
  write_config("some");
  EXPECT_EQ(again("some", {"--list", "--only", "*seed=2"}).out, "method=nee,seed=2\nmethod=rl,seed=2\n");
  EXPECT_EQ(again("some", {"--only", "*rl*"}).exit_code, 1);  // the others are missing
  EXPECT_FALSE(fs::exists(folder_ / "results/some/method=nee,seed=1"));
  EXPECT_TRUE(contains(again("some", {"--only", "nothing*"}).err, "no run fits --only 'nothing*'"));
}

}  // namespace
}  // namespace qtrace::tests
