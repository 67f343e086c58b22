// How configs say what of a scene's file is shown, and from where.
#include "engine/core/check.h"
#include "experiments/config/config_hash.h"
#include "tests/unit/config_text.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

RunConfig config_with(const std::string& camera) {
  return load(config_text(R"("camera": )" + camera + ", ")).runs.at(0).config;
}

std::string refusal_of(const std::string& camera) {
  try {
    config_with(camera);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ViewKnobs, EveryFormOfACameraIsReadAndWritten) {
  EXPECT_EQ(config_with(R"("")").camera, CameraChoice());
  EXPECT_EQ(config_with(R"("eye")").camera.of_file, (NameOrIndex{"eye", {}}));
  EXPECT_EQ(config_with("3").camera.of_file, (NameOrIndex{"", 3}));
  EXPECT_EQ(config_with(R"("fit")").camera.kind, CameraChoice::Kind::fit);
  const CameraPlace place =
      config_with(R"({"position": [1, 2, 3], "target": [4, 5, 6.5], "fov": 55})").camera.place;
  EXPECT_EQ(place, (CameraPlace{{1, 2, 3}, {4, 5, 6.5}, {0, 1, 0}, 55}));
  for (const char* text :
       {R"("")", R"("eye")", "3", R"("fit")",
        R"({"position":[1.0,2.0,3.0],"target":[4.0,5.0,6.5],"up":[0.0,1.0,0.0],"fov":55.0})"}) {
    const Json written = write_knobs(config_with(text)).at("camera");
    EXPECT_EQ(written, Json::parse(text));
    EXPECT_EQ(config_with(written.dump()).camera, config_with(text).camera);
  }
}

TEST(ViewKnobs, WhatIsNoCameraIsRefused) {
  for (const char* text : {"-1", "1.5", "true", "null", "[0,0,1]"}) {
    EXPECT_NE(refusal_of(text).find(std::string("key 'camera' is ") + text +
                                    " but must be \"fit\", a camera's name"),
              std::string::npos)
        << refusal_of(text);
  }
  EXPECT_NE(refusal_of(R"({"target": [0, 0, 0]})").find("'position' is missing"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"position": [0, 0, 0]})").find("'target' is missing"), std::string::npos);
  const auto placed = [](const std::string& more) {
    return R"({"position": [0, 0, 1], "target": [0, 0, 0], )" + more + "}";
  };
  EXPECT_NE(refusal_of(placed(R"("fov": 180)")).find("key 'camera.fov' is 180"), std::string::npos);
  EXPECT_NE(refusal_of(placed(R"("fow": 40)")).find("unknown key 'camera.fow'"), std::string::npos);
  EXPECT_NE(refusal_of(placed(R"("up": [0, 1])")).find("key 'camera.up' is [0,1]"), std::string::npos);
  EXPECT_NE(refusal_of(R"({"position": [0, 0, 1e300], "target": [0, 0, 0]})").find("camera.position[2]"),
            std::string::npos);
}

TEST(ViewKnobs, ASweepGoesOverCameras) {
  const Experiment experiment = load(config_text(R"("sweep": [{"camera": ["fit", "eye", 2]}], )"));
  ASSERT_EQ(experiment.runs.size(), 3U);
  EXPECT_EQ(experiment.runs[0].config.camera.kind, CameraChoice::Kind::fit);
  EXPECT_EQ(experiment.runs[1].config.camera.of_file.name, "eye");
  EXPECT_EQ(experiment.runs[2].id, "camera=2");
  const Experiment groups = load(config_text(
      R"("sweep": [{"from": {"above": {"camera": {"position": [0, 9, 0], "target": [0, 0, 0]}}}}], )"));
  EXPECT_EQ(groups.runs.at(0).config.camera.place.position[1], 9);
}

// The scene's own hash holds the camera, whatever it is called.
TEST(ViewKnobs, TheConfigsHashLeavesTheViewToTheScene) {
  EXPECT_EQ(config_hash(config_with("0"), "a"), config_hash(config_with(R"("eye")"), "a"));
  EXPECT_EQ(config_hash(config_with("0"), "a"), config_hash(config_with(R"("")"), "a"));
  EXPECT_NE(config_hash(config_with("0"), "a"), config_hash(config_with("0"), "b"));
}

TEST(ViewKnobs, ThePicturesSidesAreItsAspectRatio) {
  EXPECT_EQ(view_of(load(config_text(R"("width": 300, "height": 200, )")).runs.at(0).config).aspect, 1.5);
  EXPECT_EQ(view_of(load(config_text(R"("gltf_scene": "night", )")).runs.at(0).config).scene.name, "night");
}

}  // namespace
}  // namespace qtrace::experiments
