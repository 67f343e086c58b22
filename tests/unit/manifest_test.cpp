// Hashes and the parts of manifests.
#include "experiments/runtime/manifest.h"
#include "engine/scene/analytic.h"
#include "experiments/config/config_hash.h"
#include "experiments/files/hash.h"
#include "experiments/reference/reference.h"
#include "experiments/run/run.h"
#include "experiments/runtime/progress.h"
#include "experiments/runtime/scene_hash.h"
#include "experiments/study/experiment.h"
#include "tests/system/temp_folder.h"

#include <gtest/gtest.h>

#include <optional>
#include <regex>
#include <set>

namespace qtrace::experiments {
namespace {

Scene one_triangle() {
  Scene scene;
  scene.name = "one";
  scene.triangles.resize(1);
  scene.triangles[0].position = {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)};
  scene.materials.resize(1);
  scene.objects.resize(1);
  return scene;
}

TEST(ManifestHash, KnowsThePublishedTestVector) {
  EXPECT_EQ(hash_text(""), "99aa06d3014798d86001c324468d497f");  // XXH3-128 of nothing, seed 0
}

TEST(ManifestHash, SceneHashIsOfContentAlone) {
  const Scene scene = one_triangle();
  Scene same = scene;
  same.name = "other";
  same.objects[0].name = "renamed";
  same.materials[0].name = "renamed";
  same.warnings = {"w"};
  EXPECT_EQ(scene_hash(scene), scene_hash(same));
  std::set<std::string> hashes{scene_hash(scene)};
  std::vector<Scene> others(14, scene);
  others[0].triangles[0].position[2].z = 1e-6F;
  others[1].materials[0].emission.y = 1;
  others[2].materials[0].double_sided = true;
  others[3].camera.vertical_fov = 0.5F;
  others[4].objects[0].has_uv = true;
  others[5].triangles[0].uv[1].x = 0.5F;
  others[6].camera.film_height = 2;
  others[7].materials[0].transmission = 1;
  others[8].materials[0].texture(TextureSlot::normal) = Texture();
  others[9].materials[0].texture(TextureSlot::emission) = Texture();
  others[10].images = {{"", 1, 1, {{1, 2, 3, 4}}}};
  others[11].images = {{"", 1, 1, {{1, 2, 3, 5}}}};
  others[12].lights.emplace_back();
  others[13].attributes.emplace_back();
  for (const Scene& other : others) hashes.insert(scene_hash(other));
  EXPECT_EQ(hashes.size(), 15U);
}

TEST(ManifestHash, ConfigHashReplacesTheScenePathByItsContent) {
  RunConfig config;
  config.name = "a";
  config.scene = "a.glb";
  RunConfig other = config;
  other.name = "b";
  other.scene = "folder/b.glb";
  EXPECT_EQ(config_hash(config, "s"), config_hash(other, "s"));
  EXPECT_NE(config_hash(config, "s"), config_hash(config, "t"));
  other.render.rl.bin_floor = 0.2;
  EXPECT_NE(config_hash(config, "s"), config_hash(other, "s"));
}

// What is kept under these names must be found again by later programs: a knob or a member that is added
// enters a hash only where it differs from what older programs did (KnobInfo::implied, Hasher::add_later).
TEST(ManifestHash, StandsStillWhileTheProgramGrows) {
  RunConfig older;
  older.render.random = older.reference.random = RandomNumbers::independent;
  EXPECT_EQ(config_hash(older, "s"), "88e8341523e6700ac0b1bb676feed3dd");
  EXPECT_EQ(reference_spec(older, "s").hash, "6997ba0342f46cbb784c8b2ead21516c");
  EXPECT_EQ(scene_hash(furnace_box(0.5F, 0.5F)), "b063b840ee40e741e830d0b12a6e9a52");
}

struct Grown {
  int first = 1;
  double later = 0.5;
};

template <class Visitor>
void visit_knobs(Visitor& visit, Grown& grown) {
  visit(KnobInfo{"first", "", "there from the start"}, grown.first);
  visit(KnobInfo{.name = "later", .unit = "", .help = "came later", .implied = "0.25"}, grown.later);
}

TEST(ManifestHash, AKnobThatCameLaterLeavesNoTraceWhereItDoesWhatWasDoneBefore) {
  EXPECT_EQ(write_knobs(Grown{1, 0.25}, Written::identity), (Json{{"first", 1}}));
  EXPECT_EQ(write_knobs(Grown{1, 0.5}, Written::identity), (Json{{"first", 1}, {"later", 0.5}}));
  EXPECT_EQ(write_knobs(Grown{1, 0.25}), (Json{{"first", 1}, {"later", 0.25}})) << "manifests say all";
}

TEST(ManifestHash, AMemberThatCameLaterLeavesNoTraceWhereItDoesWhatWasDoneBefore) {
  const auto hash = [](std::optional<float> coat, std::optional<float> glass) {
    Hasher hasher;
    hasher.add(1);
    if (coat) hasher.add_later("coat", *coat, 0.0F);
    if (glass) hasher.add_later("glass", *glass, 0.0F);
    return hasher.digest();
  };
  EXPECT_EQ(hash({}, {}), hash(0.0F, 0.0F));
  EXPECT_NE(hash({}, {}), hash(0.5F, 0.0F));
  EXPECT_NE(hash(0.5F, 0.0F), hash(0.0F, 0.5F)) << "the same value of another member";
}

TEST(ManifestHash, CanonicalTextHasOneOrder) {
  EXPECT_EQ(canonical_text(parse_json(R"({"b": 1, "a": {"d": 2, "c": 0.1}})")),
            R"({"a":{"c":0.1,"d":2},"b":1})");
}

TEST(Manifest, TimesAreIsoInUtc) {
  EXPECT_TRUE(std::regex_match(utc_now(), std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)"))) << utc_now();
}

TEST(Manifest, SoftwareIsSaidPlainly) {
  gpu::DeviceInfo device;
  device.renderer = "llvmpipe";
  device.software = true;
  EXPECT_NE(device_text(device).find("software: computes on the CPU"), std::string::npos);
  device.software = false;
  EXPECT_EQ(device_text(device).find("software"), std::string::npos);
  EXPECT_EQ(device_json(device).at("renderer"), "llvmpipe");
}

TEST(Manifest, DurationsReadWell) {
  EXPECT_EQ(duration_text(8.4), "8 s");
  EXPECT_EQ(duration_text(185), "3 min 05 s");
  EXPECT_EQ(duration_text(2 * 3600 + 7 * 60), "2 h 07 min");
}

TEST(Manifest, ScenesWithoutLightAreWarnedOf) {
  LoadedScene loaded{"dark.glb", View(), one_triangle(), ""};
  RunConfig config;
  EXPECT_NE(light_warning(loaded, config).find("dark.glb: the scene has no light"), std::string::npos);
  config.render.environment = {0, 0, 0.1};
  EXPECT_EQ(light_warning(loaded, config), "");
  config.render.environment = {0, 0, 0};
  loaded.scene.materials[0].emission = glm::vec3(1, 0, 0);
  EXPECT_EQ(light_warning(loaded, config), "");
  loaded.scene.materials.push_back(Material{});
  loaded.scene.triangles[0].material = 1;  // nothing has the emissive one
  EXPECT_NE(light_warning(loaded, config), "");
}

}  // namespace
}  // namespace qtrace::experiments
