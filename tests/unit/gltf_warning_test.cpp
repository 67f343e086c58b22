// What a file may hold beside what is modelled: a warning each.
#include "tests/unit/gltf_builder.h"

#include <array>

namespace qtrace {
namespace {

class GltfWarningTest : public GltfTest {
 protected:
  GltfWarningTest() { gltf.add_triangle(); }
};

TEST_F(GltfWarningTest, WarnsOfExtensions) {
  gltf.json["extensionsUsed"] = {"KHR_materials_sheen", "KHR_materials_specular"};
  expect_warning("extension KHR_materials_sheen is not modelled; the scene is read without it");
}

TEST_F(GltfWarningTest, WarnsOfExtensionsThatAreNotDeclared) {
  gltf.json["materials"] = {{{"extensions", {{"KHR_materials_dispersion", {{"dispersion", 1}}}}}}};
  expect_warning(
      "extension KHR_materials_dispersion is used but not declared in extensionsUsed; it is not modelled, "
      "and the "
      "scene is read without it");
  gltf.json["extensionsUsed"] = {"KHR_materials_dispersion"};
  expect_warning("extension KHR_materials_dispersion is not modelled; the scene is read without it");
  gltf.json.erase("extensionsUsed");
  gltf.json["materials"] = {{{"extensions", {{"KHR_materials_specular", {{"specularFactor", 0.5}}}}}}};
  expect_warning(
      "extension KHR_materials_specular is used but not declared in extensionsUsed; it is read as if it "
      "were");
  gltf.json["materials"] = {{{"extras", {{"extensions", {{"EXT_mine", {{"x", 1}}}}}}}}};
  EXPECT_TRUE(load().warnings.empty()) << "extras are whatever their author likes";
}

TEST_F(GltfWarningTest, WhatIsBrokenAndUsedByNothingIsLeftOut) {
  gltf.json["textures"] = {{{"source", 7}}};
  expect_warning(
      "textures[0].source is 7; an index below 0, the number of images, would be right; it is left out, as "
      "nothing uses it");
  gltf.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  expect_error({"textures[0].source is 7; an index below 0"});
  gltf.json.erase("materials");
  gltf.json["textures"] = {{{"source", 0}}};
  gltf.json["images"] = {{{"bufferView", 99}}};
  expect_warning(
      "images[0].bufferView is 99; an index below 1, the number of bufferViews, would be right; it is left "
      "out, as nothing uses it");
  gltf.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  expect_error({"images[0].bufferView is 99; an index below 1"});
}

TEST_F(GltfWarningTest, WarnsOfAnimations) {
  gltf.json["animations"] = {{{"name", "walk"}}};
  expect_warning("animation 'walk' is not modelled; nodes keep their own transforms");
}

TEST_F(GltfWarningTest, SkipsPointsAndLines) {
  const std::vector<std::string> names{"a set of points", "a set of lines", "a line loop", "a line strip"};
  gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive_json());
  for (const int mode : {kPoints, kLines, kLineLoop, kLineStrip}) {
    gltf.primitive_json()["mode"] = mode;
    expect_warning("object 'thing': mesh 'shape' primitive 0 holds " + names[static_cast<std::size_t>(mode)] +
                   ", which has no surface; it is skipped");
    EXPECT_EQ(load().triangles.size(), 1U);
  }
  gltf.json["meshes"][0]["primitives"][1]["mode"] = kPoints;
  const Scene nothing = load();
  EXPECT_TRUE(nothing.triangles.empty());
  EXPECT_TRUE(nothing.objects.empty());
  EXPECT_EQ(nothing.warnings.back(), "the scene has no triangles; nothing but the environment is seen");
}

TEST_F(GltfWarningTest, DropsTrianglesWithoutArea) {
  gltf.json["meshes"][0]["primitives"] = {
      gltf.primitive({0, 0, 0, 1, 0, 0, 1, 1e-5F, 0}),  // thin and there
      gltf.primitive({0, 0, 0, 1, 0, 0, 1, 1e-9F, 0}),  // thinner than float positions are exact
      gltf.primitive({1, 1, 1, 2, 2, 2, 3, 3, 3}),
      gltf.primitive({5, 0, 0, 5, 0, 0, 5, 1, 0}),
  };
  expect_warning(
      "object 'thing': dropped 3 of 4 triangles for having no area: triangle 0 of mesh 'shape' primitive 1, "
      "triangle 0 of mesh 'shape' primitive 2, triangle 0 of mesh 'shape' primitive 3");
  EXPECT_EQ(load().objects.at(0).triangle_count, 1U);
  EXPECT_EQ(load().triangles.size(), 1U);
}

TEST_F(GltfWarningTest, TrianglesThatJoinStripsAreNotLost) {
  gltf.primitive_json() = gltf.primitive({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0});
  gltf.primitive_json()["indices"] = gltf.add_indices({0, 1, 2, 2, 3, 3, 4, 5});
  gltf.primitive_json()["mode"] = kStrip;
  EXPECT_TRUE(load().warnings.empty());
  EXPECT_EQ(load().triangles.size(), 2U);
}

TEST_F(GltfWarningTest, BrokenAnimationsAreLeftOut) {
  for (const nlohmann::json& animation : {nlohmann::json(5), nlohmann::json("walk"), {{"name", 5}}}) {
    gltf.json["animations"] = nlohmann::json::array({animation});
    const Scene scene = load();
    EXPECT_EQ(scene.triangles.size(), 1U);
    EXPECT_NE(::testing::PrintToString(scene.warnings).find("it is left out, as nothing uses it"),
              std::string::npos);
  }
}

TEST_F(GltfWarningTest, OmitsObjectsWithoutTriangles) {
  gltf.json["nodes"][1]["scale"] = {0, 0, 0};
  EXPECT_TRUE(load().objects.empty());
  gltf.add_node({{"name", "solid"}, {"mesh", 0}});
  const Scene scene = load();
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].name, "solid");
  EXPECT_EQ(scene.triangles.at(0).object, 0U);
  EXPECT_EQ(scene.warnings,
            (std::vector<std::string>{"object 'thing': dropped 1 of 1 triangles for having no area: "
                                      "triangle 0 of mesh 'shape' primitive 0",
                                      "object 'thing' has no triangles and is omitted"}));
}

TEST_F(GltfWarningTest, ReplacesNormalsThatCannotBeUsed) {
  gltf.primitive_json()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 0, 0, 0, 1, 0, 0, 0});
  expect_warning(
      "object 'thing': took the face's normal at 2 of 3 corners, where the file's has length zero");
  EXPECT_EQ(load().triangles.at(0).normal[0], glm::vec3(0, 0, 1));
  gltf.primitive_json()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0.6F, -0.8F, 0, 0, 1, 1, 0, 0});
  expect_warning(
      "object 'thing': took the face's normal at 2 of 3 corners, where the file's points behind the face");
  const Triangle triangle = load().triangles.at(0);
  for (const glm::vec3& normal : triangle.normal) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST_F(GltfWarningTest, PartlyMappedObjectHasNoUvMap) {
  gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive_json());
  gltf.primitive_json()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {1, 1, 2, 2, 3, 3});
  expect_warning(
      "object 'thing': only some primitives have TEXCOORD_0, so the object counts as having no UV map");
  const Scene scene = load();
  EXPECT_FALSE(scene.objects.at(0).has_uv);
  for (const glm::vec2& uv : scene.triangles.at(0).uv) EXPECT_EQ(uv, glm::vec2(0));
}

}  // namespace
}  // namespace qtrace
