// The program's face: help, usage errors, lists; and bad input, refused before anything is written.
#include "experiments/images/exr.h"
#include "tests/system/program.h"
#include "tests/system/small_scene.h"

#include <gtest/gtest.h>

namespace qtrace::tests {
namespace {

class CommandLine : public testing::Test {
 protected:
  CommandLine() { write_small_scene(folder_, "scene"); }

  Outcome qtrace(const std::vector<std::string>& arguments) const {
    return run_qtrace(arguments, folder_.path());
  }

  // Runs a config that must be refused with this message and without a trace on the disk.
  void expect_refused(const std::string& config, const std::string& message,
                      const std::vector<std::string>& more = {}) const {
    folder_.write("bad.json", config);
    const std::vector<std::string> before = tree(folder_.path());
    std::vector<std::string> arguments{"run", "bad.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = qtrace(arguments);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_TRUE(contains(outcome.err, message)) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "error: ")) << outcome.err;
    EXPECT_EQ(tree(folder_.path()), before);
  }

  TempFolder folder_;
};

TEST_F(CommandLine, HelpAndVersionSucceed) {
  const Outcome help = qtrace({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const char* command : {"run", "compare", "inspect", "devices", "keys"})
    EXPECT_TRUE(contains(help.out, command));
  EXPECT_TRUE(contains(qtrace({"run", "--help"}).out, "--dry-run"));
  const Outcome version = qtrace({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(contains(version.out, "qtrace "));
}

TEST_F(CommandLine, WrongUsageExitsWithTwo) {
  EXPECT_EQ(qtrace({}).exit_code, 2);
  EXPECT_EQ(qtrace({"fly"}).exit_code, 2);
  EXPECT_EQ(qtrace({"run"}).exit_code, 2);
  EXPECT_EQ(qtrace({"run", "c.json", "--fly"}).exit_code, 2);
  EXPECT_EQ(qtrace({"compare", "one.exr"}).exit_code, 2);
}

TEST_F(CommandLine, KeysAreListedFromTheirDeclarations) {
  const Outcome keys = qtrace({"keys"});
  EXPECT_EQ(keys.exit_code, 0);
  for (const char* key :
       {"rl.sites_per_object", "reference.frames", "one of bsdf, uniform, rl", "from 1 to 64"}) {
    EXPECT_TRUE(contains(keys.out, key)) << key;
  }
}

TEST_F(CommandLine, DevicesAreListedWithTheirKind) {
  const Outcome devices = qtrace({"devices"});
  EXPECT_EQ(devices.exit_code, 0) << devices.err;
  EXPECT_TRUE(contains(devices.out, "usable"));
  EXPECT_TRUE(contains(devices.out, "software") || contains(devices.out, "hardware"));
}

TEST_F(CommandLine, DryRunListsEverythingAndWritesNothing) {
  folder_.write("c.json",
                small_config("dry", R"("sweep": [{"seed": [1, 2]}, {"sampler": ["bsdf", "rl"]}], )"));
  const std::vector<std::string> before = tree(folder_.path());
  const Outcome outcome = qtrace({"run", "c.json", "--dry-run", "--set", "frames=3"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "dry: 4 runs"));
  EXPECT_TRUE(contains(outcome.out, "seed=2,sampler=rl"));
  EXPECT_TRUE(contains(outcome.out, "to be rendered"));
  EXPECT_EQ(tree(folder_.path()), before);
}

TEST_F(CommandLine, BadConfigsAreRefused) {
  expect_refused(small_config("x", R"("samplre": "rl", )"),
                 "bad.json: unknown key 'samplre'; did you mean 'sampler'?");
  expect_refused(small_config("x", R"("max_bounces": "5", )"), "key 'max_bounces' stands twice");
  expect_refused(small_config("x", R"("seed": "5", )"), "key 'seed' is \"5\" but must be a whole number");
  expect_refused(small_config("x", R"("flip": 1, )"), "key 'flip' is 1 but must be true or false");
  expect_refused(small_config("x", R"("rl": {"bins_phi": 1000}, )"), "from 1 to 64");
  expect_refused("{", "bad.json: not valid JSON");
  expect_refused(small_config("x", R"("sweep": [{"seed": [1, 9001]}], )"), "run 'seed=9001': ");
  expect_refused(small_config("x"), "--set: unknown key 'frame'; did you mean 'frames'?",
                 {"--set", "frame=2"});
  expect_refused(small_config("x"), "no-such-device", {"--device", "no-such-device"});
}

TEST_F(CommandLine, BadScenesAreRefusedBeforeTheFirstRun) {
  const std::string sweep = R"("sweep": [{"scene": ["scene.gltf", "other.gltf"]}], )";
  const auto with_scenes = [&sweep] {
    std::string config = small_config("x", sweep);
    return config.erase(config.find(R"("scene": "scene.gltf", )"),
                        std::string(R"("scene": "scene.gltf", )").size());
  };
  expect_refused(with_scenes(), "run 'scene=other': other.gltf: no such scene");
  folder_.write("other.gltf", "no glTF at all");
  expect_refused(with_scenes(), "other.gltf");
  expect_refused(small_config("x", R"("sweep": [{"scene": ["scene.bin"]}], )"), "scene.bin");
}

TEST_F(CommandLine, MissingConfigIsNamed) {
  const Outcome outcome = qtrace({"run", "none.json"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "none.json: cannot be read"));
}

TEST_F(CommandLine, TwoExperimentsMayNotShareAFolder) {
  folder_.write("a.json", small_config("same"));
  folder_.write("b.json", small_config("same"));
  const Outcome outcome = qtrace({"run", "a.json", "b.json"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "a.json and b.json are both called 'same'"));
}

TEST_F(CommandLine, ResultsThatCannotBeWrittenAreNamed) {
  folder_.write("c.json", small_config("x"));
  folder_.write("taken", "a file");
  const Outcome outcome = qtrace({"run", "c.json", "--out", "taken"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(contains(outcome.err, "taken: cannot be made a folder")) << outcome.err;
  EXPECT_EQ(folder_.read("taken"), "a file");
}

TEST_F(CommandLine, CompareNamesWhatIsWrong) {
  const Outcome missing = qtrace({"compare", "a.exr", "b.exr"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_TRUE(contains(missing.err, "a.exr: no such file"));
  folder_.write("a.exr", "no image");
  EXPECT_TRUE(
      contains(qtrace({"compare", "a.exr", "a.exr"}).err, "a.exr: cannot be read as an OpenEXR image"));
}

TEST_F(CommandLine, CompareTakesLayersAndDrawsHeatMaps) {
  experiments::ExrImage image{2, 1, {}, {}};
  for (const char* name : {"a.R", "a.G", "a.B"}) image.channels[name] = {1, 2};
  for (const char* name : {"b.R", "b.G", "b.B"}) image.channels[name] = {1, 4};
  write_exr(folder_ / "two.exr", image);
  const Outcome vague = qtrace({"compare", "two.exr", "two.exr"});
  EXPECT_EQ(vague.exit_code, 1);
  EXPECT_TRUE(contains(vague.err, "two.exr: has several images: name one; its layers are: a (")) << vague.err;
  const Outcome outcome = qtrace({"compare", "two.exr", "two.exr", "--layer", "b", "--reference-layer", "a",
                                  "--heat", "heat.png", "--heat-metric", "mse", "--heat-max", "8"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "\nmse                 2 ")) << outcome.out;
  EXPECT_TRUE(
      contains(outcome.out, "heat map heat.png: mse per pixel, magma, logarithmic from 0.0008 (black) to 8"))
      << outcome.out;
  EXPECT_EQ(folder_.read("heat.png").substr(1, 3), "PNG");
  EXPECT_EQ(qtrace({"compare", "two.exr", "two.exr", "--layer", "b", "--heat-metric", "psnr"}).exit_code, 2);
  EXPECT_EQ(qtrace({"compare", "two.exr", "two.exr", "--layer", "b", "--heat-max", "0"}).exit_code, 2);
}

}  // namespace
}  // namespace qtrace::tests
