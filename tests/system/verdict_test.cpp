// Expectations, references of another scene, and scenes far from the origin: what a user sees of them.
#include "tests/system/program.h"
#include "tests/system/small_scene.h"

#include "experiments/files/json.h"
#include "experiments/files/npy.h"
#include "experiments/images/exr.h"

#include <gtest/gtest.h>

namespace qtrace::tests {
namespace {

using experiments::parse_json;

class Verdicts : public testing::Test {
 protected:
  Verdicts() {
    write_small_scene(folder_, "scene");
    write_small_scene(folder_, "dark", Light::off);
  }

  Outcome run(const std::string& name, const std::string& members) const {
    folder_.write(name + ".json", small_config(name, members));
    return run_qtrace({"run", name + ".json"}, folder_.path());
  }

  TempFolder folder_;
};

TEST_F(Verdicts, AFailedExpectationIsTheExitCode) {
  const Outcome outcome = run(
      "judged",
      R"("random": "independent", "sampler": "bsdf", "nee": "one_ray", "expect.note": "two claims", "expect.tolerance": 0.5, "sweep": [{"claim": {
      "right": {"expect.against": "reference"},
      "wrong": {"expect.against": "mean", "expect.mean": 1000},
      "none": {}}}], )");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "verdict pass")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "warning: run 2/3 claim=wrong: finished")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "verdict fail: the mean of the image is "));
  EXPECT_TRUE(
      contains(outcome.out, "Runs that are not as expected:\n- claim=wrong: the mean of the image is"));
  EXPECT_TRUE(contains(outcome.out, "verdict |")) << outcome.out;
  const auto manifest = parse_json(folder_.read("results/judged/manifest.json"));
  EXPECT_EQ(manifest.at("status"), "finished");
  EXPECT_EQ(manifest.at("runs")[0].at("verdict"), "pass");
  EXPECT_EQ(manifest.at("runs")[1].at("verdict"), "fail");
  EXPECT_FALSE(manifest.at("runs")[2].contains("verdict"));
  const auto of_run = parse_json(folder_.read("results/judged/claim=wrong/manifest.json"));
  EXPECT_EQ(of_run.at("verdict"), "fail");
  EXPECT_EQ(of_run.at("config").at("expect").at("note"), "two claims");
  EXPECT_TRUE(contains(folder_.read("results/judged/summary.csv"), ",fail,the mean of the image is "));
}

TEST_F(Verdicts, MetExpectationsEndWell) {
  EXPECT_EQ(
      run("good",
          R"("random": "independent", "sampler": "bsdf", "nee": "one_ray", "expect": {"against": "reference", "tolerance": 0.5}, )")
          .exit_code,
      0);
  const Outcome plain = run("plain", "");
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_FALSE(contains(plain.out, "verdict")) << plain.out;
}

// The dark room does not look like the lit one.
TEST_F(Verdicts, AReferenceCanShowAnotherScene) {
  const Outcome outcome = run(
      "shown",
      R"("random": "independent", "sampler": "bsdf", "nee": "one_ray", "expect": {"against": "reference", "tolerance": 0.5},
      "sweep": [{"shown": {"itself": {}, "the dark one": {"reference.scene": "dark.gltf"}}}], )");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "shown=itself: finished")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "verdict fail")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "reference of dark: 16 frames rendered")) << outcome.err;
  const auto hash = [&](const std::string& label) {
    return parse_json(folder_.read("results/shown/shown=" + label + "/manifest.json"))
        .at("reference")
        .at("hash");
  };
  EXPECT_NE(hash("itself"), hash("the-dark-one"));
  const Outcome missing = run("missing", R"("reference.scene": "nowhere.glb", )");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_TRUE(contains(missing.err, "nowhere.glb: no such scene")) << missing.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "results/missing"));
}

// What is computed about the origin is written where the scene's file has it.
TEST_F(Verdicts, PositionsAreThoseOfTheFile) {
  const std::string scenes = QTRACE_SOURCE_DIR "/configs/scenes/hard/";
  const Outcome outcome =
      run("far", R"("sampler": "rl", "save_table": "last", "rl.sites_per_object": 2,
      "sweep": [{"place": {"near": {"scene": ")" +
                     scenes + R"(room.glb"}, "far": {"scene": ")" + scenes + R"(room_moved.glb"}}}], )");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto position = [&](const std::string& place) {
    return experiments::read_exr(folder_ / ("results/far/place=" + place + "/first_hit.exr")).channels;
  };
  const auto near = position("near");
  const auto far = position("far");
  const auto near_cells = experiments::read_npy<float>(folder_ / "results/far/place=near/cells.npy").values;
  const auto far_cells = experiments::read_npy<float>(folder_ / "results/far/place=far/cells.npy").values;
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_NEAR(far.at("position.X")[i], near.at("position.X")[i] + 10000, 2e-3);
    EXPECT_NEAR(far.at("position.Y")[i], near.at("position.Y")[i], 1e-5);
  }
  ASSERT_EQ(near_cells.size() % 7, 0U);
  ASSERT_GT(near_cells.size(), 0U);
  ASSERT_EQ(near_cells.size(), far_cells.size());
  for (std::size_t i = 0; i < near_cells.size(); i += 7)
    EXPECT_NEAR(far_cells[i], near_cells[i] + 10000, 2e-3);
}

}  // namespace
}  // namespace qtrace::tests
