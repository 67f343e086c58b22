// What the key 'environment' may say, and what the scene of a run and its hashes have of it.
#include "engine/core/check.h"
#include "engine/core/text.h"
#include "experiments/config/config_hash.h"
#include "experiments/reference/reference.h"
#include "experiments/run/run.h"
#include "experiments/runtime/manifest.h"
#include "experiments/runtime/scene_hash.h"
#include "experiments/study/results_folder.h"
#include "tests/unit/config_text.h"
#include "tests/unit/gltf_builder.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

namespace qtrace::experiments {
namespace {

RunConfig config_with(const std::string& environment) {
  return load(config_text(R"("environment": )" + environment + ", ")).runs.at(0).config;
}

std::string refusal_of(const std::string& environment) {
  try {
    config_with(environment);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(EnvironmentKnob, EveryFormIsReadAndWritten) {
  const RunConfig constant = config_with("[1, 2, 3.5]");
  EXPECT_FALSE(constant.environment_image);
  EXPECT_EQ(constant.render.environment, (std::array<double, 3>{1, 2, 3.5}));
  const RunConfig plain = config_with(R"({"file": "sky.exr"})");
  EXPECT_EQ(plain.environment_image, (EnvironmentImage{"sky.exr", {}, 0}));
  EXPECT_EQ(plain.render.environment, (std::array<double, 3>{}));
  const RunConfig scaled = config_with(R"({"file": "a/sky.hdr", "scale": [1, 0, 2.5], "rotation": -90})");
  EXPECT_EQ(scaled.environment_image, (EnvironmentImage{"a/sky.hdr", {{1, 0, 2.5}}, -90}));
  EXPECT_EQ(config_with(R"({"file": "s", "scale": 3})").environment_image->scale, (RadianceScale{{3, 3, 3}}));
  for (const char* text : {"[1.0,2.0,3.5]", R"({"file":"sky.exr","scale":1.0,"rotation":0.0})",
                           R"({"file":"sky.exr","scale":[1.0,2.0,3.0],"rotation":45.0})"}) {
    const Json written = write_knobs(config_with(text)).at("environment");
    EXPECT_EQ(written, Json::parse(text));
    EXPECT_EQ(write_knobs(config_with(written.dump())).at("environment"), written);
  }
}

TEST(EnvironmentKnob, WhatIsNoEnvironmentIsRefused) {
  const auto expect = [](const std::string& environment, const std::string& words) {
    const std::string refusal = refusal_of(environment);
    EXPECT_NE(refusal.find(words), std::string::npos) << refusal;
  };
  for (const char* text : {"3", "\"sky.exr\"", "true", "null", "[1,2]", "[]"})
    expect(text, std::string("key 'environment' is ") + text +
                     " but must be a list of 3, each a number from 0 to " +
                     "100000000, or {\"file\": path of an .exr or .hdr image");
  expect("[1, 2, -3]", "key 'environment[2]' is -3");
  expect("{}", "'file' is missing");
  expect(R"({"scale": 2})", "'file' is missing");
  expect(R"({"file": ""})", "'file' is missing");
  expect(R"({"file": 3})", "key 'environment.file' is 3 but must be a text");
  expect(R"({"file": "s", "scael": 2})",
         "unknown key 'environment.scael'; did you mean 'environment.scale'?");
  expect(R"({"file": "s", "scale": -1})",
         "key 'environment.scale' is -1 but must be a number from 0 to 100000000, or a list of 3");
  expect(R"({"file": "s", "scale": [1, 2]})", "key 'environment.scale' is [1,2] but must be");
  expect(R"({"file": "s", "scale": [1, 2, 1e9]})", "key 'environment.scale[2]' is 1");
  expect(R"({"file": "s", "scale": "2"})", "key 'environment.scale' is \"2\"");
  expect(R"({"file": "s", "rotation": 361})",
         "key 'environment.rotation' is 361 but must be a number from -360 to 360");
}

TEST(EnvironmentKnob, ASweepAndASettingReplaceAllOfIt) {
  const std::string text = config_text(
      R"("environment": {"file": "day.exr", "scale": 2}, "sweep": [{"environment": [[0, 0, 1], {"file": "night.exr"}]},
         {"light": {"as it is": {}}}], )");
  const Experiment experiment = load(text);
  ASSERT_EQ(experiment.runs.size(), 2U);
  EXPECT_FALSE(experiment.runs[0].config.environment_image);
  EXPECT_EQ(experiment.runs[0].config.render.environment[2], 1);
  EXPECT_EQ(experiment.runs[1].config.environment_image, (EnvironmentImage{"night.exr", {}, 0}))
      << "no scale of day.exr";
  EXPECT_EQ(experiment.runs[1].config.render.environment[2], 0);
  const Experiment set =
      load(config_text(R"("environment": [1, 1, 1], )"), {R"(environment={"file": "day.exr"})"});
  EXPECT_EQ(set.runs[0].config.environment_image, (EnvironmentImage{"day.exr", {}, 0}));
  EXPECT_EQ(set.runs[0].config.render.environment, (std::array<double, 3>{}));
  EXPECT_EQ(set.environment_image(set.runs[0])->file, (set.folder() / "day.exr").string());
  EXPECT_FALSE(load(config_text(R"("environment": {"file": "day.exr"}, )"), {"environment=[1,1,1]"})
                   .runs[0]
                   .config.environment_image);
}

TEST(EnvironmentKnob, GroupsOfASweepMaySetIt) {
  const Experiment experiment = load(config_text(
      R"("sweep": [{"light": {"day": {"environment": {"file": "day.exr", "scale": 2}}, "none": {"environment": [0, 0, 0]}}}], )"));
  ASSERT_EQ(experiment.runs.size(), 2U);
  EXPECT_EQ(experiment.runs[0].config.environment_image, (EnvironmentImage{"day.exr", {{2, 2, 2}}, 0}));
  EXPECT_FALSE(experiment.runs[1].config.environment_image);
  const auto refusal = [](const std::string& group) {
    try {
      load(config_text(R"("sweep": [{"light": {"day": )" + group + "}}], "));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(refusal(R"({"environment": {"file": "day.exr", "turn": 2}})")
                .find("run 'light=day': unknown key 'environment.turn'"),
            std::string::npos);
  EXPECT_NE(refusal(R"({"environment.scale": 2})").find("'file' is missing"), std::string::npos);
  EXPECT_NE(refusal(R"({"rl": {"turn": 2}})").find("sets the unknown key 'rl.turn'"), std::string::npos);
}

// The scene's hash holds the image, whatever its file is called.
TEST(EnvironmentKnob, TheHashesLeaveTheImageToTheScene) {
  const RunConfig none = config_with("[0, 0, 0]");
  const RunConfig image = config_with(R"({"file": "sky.exr", "scale": 2})");
  EXPECT_EQ(config_hash(none, "s"), config_hash(image, "s"));
  EXPECT_EQ(reference_spec(none, "s").hash, reference_spec(image, "s").hash);
  EXPECT_NE(config_hash(config_with("[0, 0, 1]"), "s"), config_hash(image, "s"));
}

TEST(EnvironmentKnob, TheScenesHashIsOfTheImagesContent) {
  Scene scene;
  std::set<std::string> hashes{scene_hash(scene)};
  scene.environment = EnvironmentMap{2, 1, {glm::vec3(1), glm::vec3(2)}, 0};
  std::vector<Scene> others(4, scene);
  others[1].environment->rotation = 0.5F;
  others[2].environment->radiance[1].z = 3;
  std::swap(others[3].environment->width, others[3].environment->height);
  for (const Scene& other : others) hashes.insert(scene_hash(other));
  EXPECT_EQ(hashes.size(), 5U);
  EXPECT_EQ(scene_hash(others[0]), scene_hash(scene));
}

// A folder with a triangle and images of a few texels.
class EnvironmentOfScene : public testing::Test {
 protected:
  EnvironmentOfScene() {
    GltfBuilder scene;
    scene.add_triangle();
    folder_.write("a.glb", scene.glb());
    write_sky("sky.hdr", "-Y 1 +X 2", 3);
  }

  // Two texels, or as the size says: the first of radiance (1, 1, 2), the others of `radiance`, which is not
  // 1: that would be a run.
  void write_sky(const std::string& name, const std::string& size, int radiance, int texels = 2) const {
    std::string text = "#?RADIANCE\n\n" + size + "\n\x01\x01\x02\x88";
    for (int i = 1; i < texels; ++i) text += std::string(3, static_cast<char>(radiance)) + '\x88';
    folder_.write(name, text);
  }

  const LoadedScene& scene_with(SceneStore& scenes, const EnvironmentImage& image) const {
    EnvironmentImage placed = image;
    placed.file = (folder_ / image.file).string();
    return scenes.load(folder_ / "a.glb", View(), placed);
  }

  tests::TempFolder folder_;
};

TEST_F(EnvironmentOfScene, TheImageIsAroundIt) {
  write_sky("sky.hdr", "-Y 1 +X 2", 6);
  SceneStore scenes;
  const LoadedScene& loaded = scene_with(scenes, {"sky.hdr", {{2, 1, 0.5}}, 90});
  ASSERT_TRUE(loaded.scene.environment);
  EXPECT_EQ(loaded.scene.environment->radiance, (std::vector<glm::vec3>{{2, 1, 1}, {12, 6, 3}}));
  EXPECT_NEAR(loaded.scene.environment->rotation, std::numbers::pi / 2, 1e-6);
  EXPECT_EQ(loaded.environment_file, folder_ / "sky.hdr");
  EXPECT_EQ(loaded.scene.warnings, std::vector<std::string>{});
  EXPECT_EQ(light_warning(loaded, RunConfig()), "");
  const Json json = scene_json(loaded, folder_ / "results/a");
  EXPECT_EQ(json.at("environment").at("from_here"), "../../sky.hdr");
  EXPECT_EQ(json.at("environment").at("file"), (folder_ / "sky.hdr").string());
  EXPECT_FALSE(scene_json(scenes.load(folder_ / "a.glb"), folder_.path()).contains("environment"));
}

TEST_F(EnvironmentOfScene, ABlackOneIsNoLight) {
  SceneStore scenes;
  EXPECT_NE(light_warning(scene_with(scenes, {"sky.hdr", {{0, 0, 0}}, 0}), RunConfig()), "");
}

TEST_F(EnvironmentOfScene, EachIsLoadedOnce) {
  SceneStore scenes;
  std::set<const LoadedScene*> loaded{&scenes.load(folder_ / "a.glb")};
  loaded.insert(&scene_with(scenes, {"sky.hdr", {}, 0}));
  loaded.insert(&scene_with(scenes, {"sky.hdr", {}, 0}));
  loaded.insert(&scene_with(scenes, {"sky.hdr", {}, 1}));
  loaded.insert(&scene_with(scenes, {"sky.hdr", {{1, 1, 2}}, 0}));
  EXPECT_EQ(loaded.size(), 4U);
  std::set<std::string> hashes;
  for (const LoadedScene* scene : loaded) hashes.insert(scene->hash);
  EXPECT_EQ(hashes.size(), 4U);
}

TEST_F(EnvironmentOfScene, AChangedImageIsAnotherScene) {
  SceneStore before;
  const std::string hash = scene_with(before, {"sky.hdr", {}, 0}).hash;
  write_sky("sky.hdr", "-Y 1 +X 2", 2);
  SceneStore after;
  EXPECT_NE(scene_with(after, {"sky.hdr", {}, 0}).hash, hash);
}

TEST_F(EnvironmentOfScene, AnotherShapeThanTwoToOneIsWarnedOf) {
  write_sky("square.hdr", "-Y 2 +X 2", 3, 4);
  SceneStore scenes;
  const LoadedScene& loaded = scene_with(scenes, {"square.hdr", {}, 0});
  ASSERT_EQ(loaded.scene.warnings.size(), 1U);
  EXPECT_NE(loaded.scene.warnings[0].find(
                "square.hdr has 2x2 texels; all directions in latitude and longitude are twice"),
            std::string::npos);
}

TEST_F(EnvironmentOfScene, IsPartOfWhatResultsAreOf) {
  const auto identity = [&](const std::string& environment) {
    folder_.write("c.json", config_text(R"("environment": )" + environment + ", "));
    SceneStore scenes;
    return identity_json(load_experiment(folder_ / "c.json"), scenes, {});
  };
  const Json constant = identity("[1, 1, 1]").at("scenes");
  EXPECT_TRUE(constant.contains("a.glb")) << constant;
  const Json before = identity(R"({"file": "sky.hdr"})");
  EXPECT_TRUE(
      before.at("scenes").contains(R"(a.glb, environment {"file":"sky.hdr","scale":1.0,"rotation":0.0})"))
      << before.at("scenes");
  EXPECT_EQ(before.at("config").at("environment"), (Json{{"file", "sky.hdr"}})) << "as it was given";
  write_sky("sky.hdr", "-Y 1 +X 2", 2);
  const std::vector<std::string> changes = identity_changes(before, identity(R"({"file": "sky.hdr"})"));
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_NE(changes[0].find("sky.hdr"), std::string::npos) << changes[0];
}

}  // namespace
}  // namespace qtrace::experiments
