// Presets: a config over the settings of another file.
#include "engine/core/check.h"
#include "experiments/config/experiment_config.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace qtrace::experiments {
namespace {

class Presets : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
  }
  Experiment load(const std::string& keys) const {
    write("c.json", R"({"name": "n", "scene": "s.glb", )" + keys + "}");
    return load_experiment(folder_.path() / "c.json");
  }
  std::string error(const std::string& keys) const {
    try {
      load(keys);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  }
  tests::TempFolder folder_;
};

TEST_F(Presets, AreOverriddenByTheConfigAndItsSweep) {
  write("p.json", R"({"max_bounces": 3, "rl": {"shrinkage": 7, "bins_theta": 5}, "rl.bins_phi": 4})");
  const Experiment experiment =
      load(R"("preset": "p.json", "rl": {"bins_theta": 6}, "sweep": [{"rl.bins_phi": [2, 3]}])");
  ASSERT_EQ(experiment.runs.size(), 2U);
  const RenderSettings& render = experiment.runs[1].config.render;
  EXPECT_EQ(render.max_bounces, 3);
  EXPECT_EQ(render.rl.shrinkage, 7);
  EXPECT_EQ(render.rl.bins_theta, 6);
  EXPECT_EQ(render.rl.bins_phi, 3);
}

TEST_F(Presets, ErrorsNameTheFileAndWhatIsWrong) {
  EXPECT_NE(error(R"("preset": "none.json")").find("none.json\": there is no such file"), std::string::npos);
  EXPECT_NE(error(R"("preset": ")" + std::string(300, 'a') + "\"").find("there is no such file"),
            std::string::npos)
      << "a name that is longer than any file's";
  write("p.json", R"({"rl": {"shrinkag": 1}})");
  EXPECT_NE(error(R"("preset": "p.json")").find("'rl.shrinkag'"), std::string::npos);
  EXPECT_NE(error(R"("preset": "p.json")").find("p.json"), std::string::npos);
  write("p.json", R"({"name": "other"})");
  EXPECT_NE(error(R"("preset": "p.json")").find("sets 'name'"), std::string::npos);
  write("p.json", R"({"sweep": []})");
  EXPECT_NE(error(R"("preset": "p.json")").find("'sweep'"), std::string::npos);
  write("p.json", "[]");
  EXPECT_NE(error(R"("preset": "p.json")").find("must hold one JSON object"), std::string::npos);
}

// The settings of Goswami 2020, spelled out once for configs and once for tests.
TEST(Preset, OfThePaperIsWhatThePaperStates) {
  const Experiment experiment = load_experiment(QTRACE_SOURCE_DIR "/configs/paper_table.json");
  const RlSettings& rl = experiment.runs.back().config.render.rl;
  EXPECT_EQ(rl.bsdf_fraction, 0);
  EXPECT_EQ(rl.mixture, Mixture::fixed);
  EXPECT_EQ(rl.learns, Learns::all);
  EXPECT_EQ(rl.site_placement, SitePlacement::uv);
  EXPECT_EQ(rl.sites_per_object, 100);
  EXPECT_EQ(rl.bins_theta * rl.bins_phi, 100);
  EXPECT_EQ(rl.shrinkage, 0);
  EXPECT_EQ(rl.bin_weight, BinWeight::value);
  EXPECT_EQ(rl.roulette, Roulette::throughput);
  EXPECT_EQ(rl.initial_table, InitialTable::random);
  EXPECT_EQ(rl.update_growth, 0);
  EXPECT_EQ(rl.teach_frames, 0);
}

}  // namespace
}  // namespace qtrace::experiments
