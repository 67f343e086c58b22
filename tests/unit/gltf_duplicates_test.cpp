// Emitters that lie exactly on others, and scenes far from their origin.
#include "tests/unit/gltf_builder.h"
#include "tests/unit/picture_files.h"

namespace qtrace {
namespace {

class GltfDuplicates : public GltfTest {
 protected:
  // A second node with the first one's corners, in the order of `corners`; each has a material of its own.
  void add_second(const std::vector<float>& corners, const nlohmann::json& first,
                  const nlohmann::json& second) {
    gltf.json["materials"] = {first, second};
    gltf.primitive_json()["material"] = 0;
    nlohmann::json primitive = gltf.primitive(corners);
    primitive["material"] = 1;
    gltf.add_node({{"name", "second"}, {"mesh", gltf.add_mesh({primitive}, "again")}});
  }

  const std::vector<float> same{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<float> rotated{1, 0, 0, 0, 1, 0, -0.0F, 0, 0};
  const std::vector<float> turned{0, 0, 0, 0, 1, 0, 1, 0, 0};
  const nlohmann::json plain{{"name", "plain"}};
  const nlohmann::json glow{{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}};
};

constexpr const char* kDropped =
    "object 'second': dropped 1 of 1 triangles that lie exactly on others, the first of them triangle 0 of "
    "object 'second', about (0.3333, 0.3333, 0), on triangle 0 of object 'thing'";

TEST_F(GltfDuplicates, OnlyTheFirstIsKeptWhateverTheOrderOfItsCorners) {
  for (const auto& corners : {same, rotated}) {
    gltf = GltfBuilder();
    gltf.add_triangle();
    add_second(corners, glow, glow);
    const Scene scene = load();
    EXPECT_EQ(scene.warnings, std::vector<std::string>{kDropped});
    ASSERT_EQ(scene.triangles.size(), 1U);
    EXPECT_EQ(scene.triangles[0].material, 0U);
    ASSERT_EQ(scene.objects.size(), 1U);
    EXPECT_EQ(scene.objects[0].name, "thing");
  }
}

// What is left of an object moves up, and the objects after one that is gone.
TEST_F(GltfDuplicates, ObjectsKeepTheirOtherTriangles) {
  gltf.add_triangle();
  const auto mesh =
      gltf.add_mesh({gltf.primitive(rotated), gltf.primitive({0, 0, 5, 1, 0, 5, 0, 1, 5})}, "two");
  for (auto& primitive : gltf.json["meshes"][1]["primitives"]) primitive["material"] = 0;
  gltf.primitive_json()["material"] = 0;
  gltf.json["materials"] = {glow};
  gltf.add_node({{"name", "gone"}, {"mesh", 0}});
  gltf.add_node({{"name", "two"}, {"mesh", mesh}});
  const Scene scene = load();
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[1].name, "two");
  EXPECT_EQ(scene.objects[1].first_triangle, 1U);
  EXPECT_EQ(scene.objects[1].triangle_count, 1U);
  ASSERT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(scene.triangles[1].object, 1U);
  EXPECT_EQ(scene.triangles[1].position[0].z, 5);
  EXPECT_EQ(scene.warnings.size(), 2U);
}

// Solids that touch share faces; nothing of the image depends on them.
TEST_F(GltfDuplicates, WhatDoesNotEmitStays) {
  gltf.add_triangle();
  add_second(turned, plain, plain);
  const Scene scene = load();
  EXPECT_EQ(scene.triangles.size(), 2U);
  EXPECT_TRUE(scene.warnings.empty());
}

// Where one would hide the light of the other, the scene is refused, and both are named.
TEST_F(GltfDuplicates, EmittersOnWhatEmitsOtherwiseAreRefused) {
  const std::initializer_list<std::string_view> message{
      "triangle 0 of object 'thing' and triangle 0 of object 'second', about (0.3333, 0.3333, 0)",
      "have the same corners but do not emit alike; only one of them would be right"};
  gltf.add_triangle();
  add_second(same, glow, glow);
  EXPECT_EQ(load().triangles.size(), 1U);
  gltf.json["materials"][0]["doubleSided"] = true;
  expect_error(message);
}

// Whatever their order.
// Of the same texture the same part must lie on both.
TEST_F(GltfDuplicates, TexturedEmittersMustHaveTheSameCoordinates) {
  gltf.add_triangle();
  add_second(rotated, glow, glow);
  const std::size_t texture = gltf.add_texture(png_of(1, 2, 3));
  for (nlohmann::json& material : gltf.json["materials"]) material["emissiveTexture"]["index"] = texture;
  nlohmann::json& first = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  nlohmann::json& second = gltf.json["meshes"][1]["primitives"][0]["attributes"];
  first["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
  second["TEXCOORD_0"] = gltf.add_floats("VEC2", {1, 0, 0, 1, 0, 0});
  EXPECT_EQ(load().warnings, std::vector<std::string>{kDropped});
  second["TEXCOORD_0"] = first["TEXCOORD_0"];
  expect_error({"have the same corners but do not emit alike"});
}

TEST_F(GltfDuplicates, WhatEmitsTakesThePlaceOfWhatDoesNot) {
  for (const auto& corners : {same, rotated}) {
    gltf = GltfBuilder();
    gltf.add_triangle();
    add_second(corners, plain, glow);
    for (const char* winner : {"second", "thing"}) {
      const Scene scene = load();
      ASSERT_EQ(scene.triangles.size(), 1U);
      EXPECT_EQ(scene.objects.at(0).name, winner);
      EXPECT_EQ(scene.materials.at(scene.triangles[0].material).name, "glow");
      EXPECT_EQ(scene.warnings.size(), 1U);
      gltf.json["materials"] = {glow, plain};
    }
  }
}

// Two corners in common are no duplicate.
TEST_F(GltfDuplicates, NeighboursStay) {
  gltf.add_triangle();
  add_second({0, 0, 0, 1, 0, 0, 0, -1, 0}, glow, glow);
  const Scene scene = load();
  EXPECT_EQ(scene.triangles.size(), 2U);
  EXPECT_TRUE(scene.warnings.empty());
}

using GltfOrigin = GltfTest;

// At 10,000 a float resolves a thousandth: moved to the origin first, a triangle of a thousandth keeps its
// shape.
TEST_F(GltfOrigin, FarScenesAreMovedAboutTheOrigin) {
  gltf.add_triangle();
  gltf.json["nodes"][0]["translation"] = {10000, 0, 0.002};
  gltf.json["nodes"][1]["translation"] = {10000, 0, 0};
  gltf.json["nodes"][1]["scale"] = {0.001, 0.001, 0.001};
  const Scene scene = load();
  EXPECT_NEAR(scene.origin.x, 10000.0005, 1e-9);
  EXPECT_NEAR(scene.origin.y, 0.0005, 1e-9);
  const auto& p = scene.triangles.at(0).position;
  EXPECT_NEAR(double{p[1].x} - p[0].x, 0.001, 1e-9);
  EXPECT_NEAR(p[0].x, -0.0005, 1e-9);
  EXPECT_NEAR(p[2].y, 0.0005, 1e-9);
  EXPECT_NEAR(scene.camera.world_from_camera[3].x, -0.0005, 1e-9);
  EXPECT_NEAR(scene.camera.world_from_camera[3].z, 0.002, 1e-9);
}

TEST_F(GltfOrigin, OthersStayAsTheyAre) {
  gltf.add_triangle();
  gltf.json["nodes"][1]["translation"] = {-30, 0, 20};
  const Scene scene = load();
  EXPECT_EQ(scene.origin, glm::dvec3(0.0));
  EXPECT_EQ(scene.triangles.at(0).position[1], glm::vec3(-29, 0, 20));
}

}  // namespace
}  // namespace qtrace
