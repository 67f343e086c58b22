// References as users meet them: extended, resumed, of a stated noise, shipped, damaged.
#include "tests/support/statistics.h"
#include "tests/system/program.h"
#include "tests/system/small_scene.h"

#include "experiments/files/state_file.h"
#include "experiments/images/exr.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

namespace qtrace::tests {
namespace {

namespace fs = std::filesystem;
using experiments::Json;
using experiments::parse_json;

class ReferenceProgram : public testing::Test {
 protected:
  ReferenceProgram() {
    write_small_scene(folder_, "scene");
    folder_.write("c.json", small_config("c"));
  }

  std::vector<std::string> arguments(const std::string& out, const std::vector<std::string>& sets) const {
    std::vector<std::string> all{"run", "c.json", "--out", out, "--set", "reference.random=independent"};
    for (const std::string& set : sets) all.insert(all.end(), {"--set", "reference." + set});
    return all;
  }

  Outcome run(const std::string& out, const std::vector<std::string>& sets) const {
    std::vector<std::string> words = arguments(out, sets);
    words.emplace_back("--fresh");  // the references stay
    const Outcome outcome = run_qtrace(words, folder_.path());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome;
  }

  // The only file of a folder with this ending; empty where there is none.
  std::string file(const std::string& folder, const std::string& ending) const {
    if (!fs::exists(folder_ / folder)) return "";
    for (const std::string& name : tree(folder_ / folder)) {
      if (name.ends_with(ending)) return folder + "/" + name;
    }
    return "";
  }
  std::string exr(const std::string& out) const { return file(out + "/references", ".exr"); }
  std::string state(const std::string& out) const { return file(out + "/references", ".state"); }

  Json manifest(const std::string& out, const std::string& run = "run") const {
    return parse_json(folder_.read(out + "/c/" + run + "/manifest.json")).at("reference");
  }

  TempFolder folder_;
};

TEST_F(ReferenceProgram, AnExtendedOneHasTheBitsOfOneGo) {
  run("a", {"frames=8"});
  EXPECT_EQ(manifest("a").at("origin"), "rendered");
  const Outcome extended = run("a", {"frames=21"});
  EXPECT_TRUE(contains(extended.err, "reference of scene: 13 frames rendered after 8 earlier ones"))
      << extended.err;
  EXPECT_EQ(manifest("a").at("origin"), "extended");
  run("b", {"frames=21"});
  EXPECT_EQ(folder_.read(exr("a")), folder_.read(exr("b")));
  const Json parts = parse_json(folder_.read(file("a/references", ".json"))).at("parts");
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[1].at("first_frame"), 9);
  EXPECT_EQ(parts[1].at("last_frame"), 21);
  // A longer one serves a shorter wish as it is, and says how long it is.
  const Outcome shorter = run("a", {"frames=5"});
  EXPECT_FALSE(contains(shorter.err, "rendered")) << shorter.err;
  EXPECT_TRUE(contains(shorter.out, "- scene: 21 frames of 8×8")) << shorter.out;
  EXPECT_EQ(manifest("a").at("samples"), 21);
  EXPECT_EQ(manifest("a").at("wish"), "5 frames");
}

// Sixteen sequences, each as long as the others.
TEST_F(ReferenceProgram, OneOfSobolPointsIsExtendedToTheSameBits) {
  run("a", {"frames=16", "random=sobol"});
  EXPECT_EQ(manifest("a").at("samples"), 16);
  run("a", {"frames=40", "random=sobol"});
  EXPECT_EQ(manifest("a").at("origin"), "extended");
  EXPECT_EQ(manifest("a").at("samples"), 48) << "not a whole number of points for each sequence";
  run("b", {"frames=48", "random=sobol"});
  EXPECT_EQ(folder_.read(exr("a")), folder_.read(exr("b")));
  const experiments::ExrImage image = experiments::read_exr(folder_ / exr("a"));
  EXPECT_EQ(image.metadata.at("varianceNote").find("of the mean, from the spread of 16 replicates"), 0U);
  run("c", {"frames=48"});
  EXPECT_NE(fs::path(exr("c")).filename(), fs::path(exr("a")).filename());
}

TEST_F(ReferenceProgram, AKilledRenderGoesOnWithTheSameBits) {
  const bool killed = kill_qtrace_when(arguments("a", {"frames=10000000"}), folder_.path(),
                                       [&] { return !state("a").empty(); });
  ASSERT_TRUE(killed);
  EXPECT_EQ(exr("a"), "");
  const std::uint32_t frames = experiments::read_state(folder_ / state("a")).state.frames;
  ASSERT_GT(frames, 0U);
  const std::string wish = fmt::format("frames={}", frames + 5);
  const Outcome dry = run_qtrace(
      {"run", "c.json", "--out", "a", "--dry-run", "--set", "reference.random=independent"}, folder_.path());
  EXPECT_TRUE(contains(dry.out, fmt::format("8 frames, to be extended from {} frames", frames))) << dry.out;
  const Outcome resumed = run("a", {wish});
  EXPECT_TRUE(contains(resumed.err, fmt::format(" 5 frames rendered after {} earlier ones", frames)))
      << resumed.err;
  run("b", {wish});
  EXPECT_EQ(folder_.read(exr("a")), folder_.read(exr("b")));
}

TEST_F(ReferenceProgram, AStatedNoiseIsReachedAndNotByFar) {
  const Outcome outcome = run("a", {"frames=8", "relative_error=0.03"});
  const Json reached = manifest("a");
  EXPECT_LE(reached.at("reference_relative_error").get<double>(), 0.03);
  EXPECT_EQ(reached.at("meets_wish"), true);
  EXPECT_FALSE(contains(outcome.err, "warning: the reference")) << outcome.err;
  const int samples = reached.at("samples").get<int>();
  ASSERT_GE(samples, 32);
  run("b", {fmt::format("frames={}", samples - 16)});
  EXPECT_GT(manifest("b").at("reference_relative_error").get<double>(), 0.03);
  // From there, the same.
  run("b", {"frames=8", "relative_error=0.03"});
  EXPECT_EQ(folder_.read(exr("a")), folder_.read(exr("b")));
}

TEST_F(ReferenceProgram, WhereMaxFramesEndsItEverythingSaysSo) {
  const std::vector<std::string> wish{"frames=8", "relative_error=0.001", "max_frames=20"};
  for (const char* origin : {"rendered", "found"}) {
    const Outcome outcome = run("a", wish);
    EXPECT_EQ(manifest("a").at("origin"), origin);
    EXPECT_EQ(manifest("a").at("samples"), 20);
    EXPECT_EQ(manifest("a").at("meets_wish"), false);
    for (const std::string& text : {outcome.err, outcome.out, folder_.read("a/c/run/manifest.json")}) {
      EXPECT_TRUE(contains(text, "after 20 frames where 0.001 was wished: reference.max_frames ended it"))
          << text;
    }
  }
  const Outcome refused =
      run_qtrace(arguments("a", {"frames=8", "relative_error=0.001", "max_frames=7"}), folder_.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(contains(refused.err, "key 'reference.frames' is 8 but must be at most 'reference.max_frames'"))
      << refused.err;
}

TEST_F(ReferenceProgram, ADamagedStateIsNamedAndCostsNoReference) {
  run("a", {"frames=8"});
  const std::string good = folder_.read(exr("a"));
  const std::string whole = folder_.read(state("a"));
  std::string damaged = whole;
  damaged[damaged.size() / 2] ^= 1;
  for (const std::string& content : {damaged, whole.substr(0, whole.size() / 2), std::string()}) {
    folder_.write(state("a"), content);
    EXPECT_FALSE(contains(run("a", {"frames=8"}).err, "cannot be used"));
    EXPECT_EQ(folder_.read(exr("a")), good);
    fs::copy(folder_ / "a", folder_ / "c", fs::copy_options::recursive);
    const Outcome longer = run("c", {"frames=11"});
    EXPECT_TRUE(contains(longer.err, "rendered from its first frame: " + state("c"))) << longer.err;
    EXPECT_TRUE(contains(longer.err, "11 frames rendered in")) << longer.err;
    run("b", {"frames=11"});
    EXPECT_EQ(folder_.read(exr("c")), folder_.read(exr("b")));
    fs::remove_all(folder_ / "c");
  }
}

TEST_F(ReferenceProgram, AShippedOneIsUsedAndNeverWrittenTo) {
  run("a", {"frames=8"});
  const std::string name = fs::path(exr("a")).filename().string();
  const std::string shipped = folder_.read(exr("a"));
  folder_.write("references/" + name, shipped);
  const auto expect_untouched = [&] {
    EXPECT_EQ(tree(folder_ / "references"), std::vector<std::string>{name});
    EXPECT_EQ(folder_.read("references/" + name), shipped);
  };
  run("b", {"frames=8"});
  EXPECT_EQ(manifest("b").at("origin"), "shipped");
  EXPECT_EQ(exr("b"), "");
  expect_untouched();
  // It has no state to go on from.
  EXPECT_TRUE(contains(run("b", {"frames=9"}).err, "9 frames rendered in"));
  EXPECT_EQ(manifest("b").at("origin"), "rendered");
  EXPECT_EQ(manifest("b").at("samples"), 9);
  expect_untouched();
}

TEST_F(ReferenceProgram, RunsThatWishDifferentLengthsShareTheLongest) {
  folder_.write("c.json", R"({"name": "c", "scene": "scene.gltf", "width": 8, "height": 8, "frames": 2,
                              "max_bounces": 3, "sweep": [{"reference.frames": [4, 9]}]})");
  run("a", {});
  EXPECT_EQ(manifest("a", "reference.frames=4").at("samples"), 9);
  EXPECT_EQ(manifest("a", "reference.frames=9").at("samples"), 9);
}

// The halves give the noise without the variance. Per pixel and channel E[(half1 - half2)^2 / 4] is the
// variance of the mean of both.
TEST_F(ReferenceProgram, HalvesAgreeWithTheVariance) {
  folder_.write("c.json", R"({"name": "c", "scene": "scene.gltf", "width": 32, "height": 32, "frames": 2,
                              "max_bounces": 3, "reference": {"frames": 64}})");
  run("a", {});
  const experiments::ExrImage image = experiments::read_exr(folder_ / exr("a"));
  EXPECT_EQ(image.metadata.at("halves"), "half1: mean of the 32 odd frames, half2: of the 32 even ones");
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < 32 * 32; ++i) {
    double difference = 0;  // of a pixel: its channels are not independent
    for (const std::string channel : {"R", "G", "B"}) {
      const double a = image.channels.at("half1." + channel)[i];
      const double b = image.channels.at("half2." + channel)[i];
      const double mean = image.channels.at(channel)[i];
      EXPECT_NEAR((a + b) / 2, mean, 1e-6 * (1 + mean));
      difference += (a - b) * (a - b) / 4 - image.channels.at("variance." + channel)[i];
    }
    sum += difference;
    squares += difference * difference;
  }
  EXPECT_GT(squares, 0);
  EXPECT_LT(std::abs(sum) / std::sqrt(squares), test::z_threshold(1));
}

}  // namespace
}  // namespace qtrace::tests
