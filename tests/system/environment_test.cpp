// A run with an image around its scene, and what depends on that image afterwards.
#include "tests/system/run_program.h"

namespace qtrace::tests {
namespace {

class EnvironmentProgram : public RunProgram {
 protected:
  // Two texels; the second of this radiance, which is not 1.
  void write_sky(char radiance) const {
    folder_.write("sky/s.hdr",
                  "#?RADIANCE\n\n-Y 1 +X 2\n\x01\x01\x02\x88" + std::string(3, radiance) + '\x88');
  }
};

constexpr const char* kSky = R"("environment": {"file": "sky/s.hdr", "rotation": 90}, )";

TEST_F(EnvironmentProgram, IsFoundAgainByItsContent) {
  write_sky(3);
  const std::string learned = R"("save_table": "last", "sampler": "rl", )";
  ASSERT_EQ(run("a", kSky + learned).exit_code, 0);
  const Json manifest = json("results/a/run/manifest.json");
  EXPECT_EQ(manifest.at("scene").at("environment").at("from_here"), "../../../sky/s.hdr");
  EXPECT_EQ(manifest.at("config").at("environment").at("file"), "sky/s.hdr");
  EXPECT_EQ(json("results/a/manifest.json").at("config").at("environment"),
            (Json{{"file", "sky/s.hdr"}, {"rotation", 90}}));

  // From another folder, in which the manifest's paths lead nowhere.
  std::filesystem::create_directories(folder_ / "elsewhere");
  const Outcome again = run_qtrace({"rerun", "../results/a/run/manifest.json"}, folder_ / "elsewhere");
  EXPECT_EQ(again.exit_code, 0) << again.out << again.err;
  EXPECT_EQ(
      run_qtrace({"inspect", "results/a/run", "--samples", "2", "--pixel", "4,7"}, folder_.path()).exit_code,
      0);

  write_sky(4);
  const Outcome changed = run_qtrace({"rerun", "results/a/run/manifest.json"}, folder_.path());
  EXPECT_TRUE(contains(changed.err, "sky/s.hdr is not what was rendered then")) << changed.err;
  EXPECT_EQ(
      run_qtrace({"inspect", "results/a/run", "--samples", "2", "--pixel", "4,7"}, folder_.path()).exit_code,
      1);
  const Outcome more = run("a", kSky + learned);
  EXPECT_EQ(more.exit_code, 1);
  EXPECT_TRUE(contains(more.err, "holds results of something else")) << more.err;
  EXPECT_TRUE(contains(more.err, "s.hdr")) << more.err;
}

TEST_F(EnvironmentProgram, AnotherImageHasAnotherReference) {
  write_sky(3);
  ASSERT_EQ(run("a", kSky).exit_code, 0);
  ASSERT_EQ(run("b", kSky).exit_code, 0);
  write_sky(4);
  ASSERT_EQ(run("c", kSky).exit_code, 0);
  const auto hash = [&](const std::string& name) {
    return json("results/" + name + "/run/manifest.json").at("reference").at("hash").get<std::string>();
  };
  EXPECT_EQ(hash("a"), hash("b"));
  EXPECT_NE(hash("a"), hash("c"));
}

}  // namespace
}  // namespace qtrace::tests
