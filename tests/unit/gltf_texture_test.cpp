// How materials of glTF files use images.
#include "tests/unit/gltf_builder.h"
#include "tests/unit/picture_files.h"

#include <cmath>

namespace qtrace {
namespace {

class GltfTextureTest : public GltfTest {
 protected:
  GltfTextureTest() {
    gltf.add_triangle();
    gltf.primitive_json()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 0.5F, 0, 0, 0.25F});
    gltf.primitive_json()["attributes"]["TEXCOORD_1"] = gltf.add_floats("VEC2", {1, 2, 3, 4, 5, 6});
    gltf.material()["name"] = "wood";
    texture_info() = {{"index", gltf.add_texture(png_of(1, 2, 3))}};
  }
  nlohmann::json& texture_info() { return gltf.material()["pbrMetallicRoughness"]["baseColorTexture"]; }
  nlohmann::json& transform() {
    gltf.json["extensionsUsed"] = {"KHR_texture_transform"};
    return texture_info()["extensions"]["KHR_texture_transform"];
  }
  Texture read() {
    const Scene scene = load();
    EXPECT_TRUE(scene.warnings.empty()) << ::testing::PrintToString(scene.warnings);
    return scene.materials.at(0).texture(TextureSlot::base_color).value();
  }
  void expect_maps(const glm::vec2& uv, const glm::vec2& to) {
    const glm::vec2 found = read().image_from_uv * glm::vec3(uv, 1);
    EXPECT_NEAR(found.x, to.x, 1e-6);
    EXPECT_NEAR(found.y, to.y, 1e-6);
  }
};

TEST_F(GltfTextureTest, TakesTheDefaultsOfTheFormat) {
  EXPECT_EQ(read(), Texture());
  EXPECT_EQ(load().triangles.at(0).attributes, kNoAttributes);
  gltf.json["samplers"] = {nlohmann::json::object()};
  gltf.json["textures"][0]["sampler"] = 0;
  EXPECT_EQ(read(), Texture());
}

TEST_F(GltfTextureTest, ReadsSamplers) {
  gltf.json["textures"][0]["sampler"] = 0;
  gltf.json["samplers"] = {{{"wrapS", 33648}, {"wrapT", 33071}, {"magFilter", 9728}, {"minFilter", 9987}}};
  EXPECT_EQ(read().wrap_u, Wrap::mirrored_repeat);
  EXPECT_EQ(read().wrap_v, Wrap::clamp_to_edge);
  EXPECT_TRUE(read().is_nearest);
  gltf.json["samplers"] = {{{"wrapS", 10497}, {"wrapT", 33648}, {"magFilter", 9729}}};
  EXPECT_EQ(read().wrap_u, Wrap::repeat);
  EXPECT_EQ(read().wrap_v, Wrap::mirrored_repeat);
  EXPECT_FALSE(read().is_nearest);
  gltf.json["samplers"] = {{{"wrapS", 5}}};
  expect_error({"samplers[0].wrapS is 5; one of 10497 33071 33648 would be right"});
  gltf.json["textures"][0].erase("sampler");
  expect_warning(
      "samplers[0].wrapS is 5; one of 10497 33071 33648 would be right; it is left out, as nothing uses it");
}

TEST_F(GltfTextureTest, EachSlotIsRead) {
  const auto info = [](int set) { return nlohmann::json{{"index", 0}, {"texCoord", set}}; };
  nlohmann::json& material = gltf.material();
  material = {
      {"pbrMetallicRoughness", {{"baseColorTexture", info(0)}, {"metallicRoughnessTexture", info(1)}}},
      {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
      {"emissiveTexture", info(1)},
      {"emissiveFactor", {1, 2, 3}}};
  material["extensions"] = {
      {"KHR_materials_specular", {{"specularTexture", info(0)}, {"specularColorTexture", info(1)}}},
      {"KHR_materials_transmission", {{"transmissionFactor", 1}, {"transmissionTexture", info(1)}}},
      {"KHR_materials_clearcoat",
       {{"clearcoatFactor", 1},
        {"clearcoatTexture", info(0)},
        {"clearcoatRoughnessTexture", info(1)},
        {"clearcoatNormalTexture", {{"index", 0}, {"scale", -2}}}}}};
  const Scene scene = load();
  const Material& read = scene.materials.at(0);
  const std::array<int, kTextureSlots> sets{0, 1, 0, 1, 0, 1, 1, 0, 1, 0};
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    ASSERT_TRUE(read.textures[slot]) << slot;
    EXPECT_EQ(read.textures[slot]->uv_set, sets[slot]) << slot;
  }
  EXPECT_EQ(read.normal_scale, 0.5F);
  EXPECT_EQ(read.clearcoat_normal_scale, -2);
  EXPECT_EQ(read.emission, glm::vec3(1, 2, 3)) << "the texture is multiplied with it";
  EXPECT_EQ(scene.images.size(), 1U);
}

TEST_F(GltfTextureTest, ReadsTheSecondSetOfCoordinates) {
  texture_info()["texCoord"] = 1;
  EXPECT_EQ(read().uv_set, 1);
  const Scene scene = load();
  ASSERT_EQ(scene.attributes.size(), 1U);
  EXPECT_EQ(scene.triangles.at(0).attributes, 0U);
  EXPECT_EQ(scene.attributes[0].uv1, (std::array{glm::vec2(1, 2), glm::vec2(3, 4), glm::vec2(5, 6)}));
  texture_info()["texCoord"] = 2;
  expect_error({"material 'wood': baseColorTexture has coordinates TEXCOORD_2; TEXCOORD_0 or TEXCOORD_1"});
  gltf.material()["occlusionTexture"] = texture_info();
  texture_info()["texCoord"] = 0;
  EXPECT_EQ(read().uv_set, 0) << "nobody reads what occlusion has";
}

TEST_F(GltfTextureTest, CoordinatesThatNoTextureReadsMayBeBroken) {
  gltf.primitive_json()["attributes"]["TEXCOORD_1"] = 0;  // VEC3
  EXPECT_EQ(read().uv_set, 0);
  texture_info()["texCoord"] = 1;
  expect_error({"mesh 'shape' primitive 0 TEXCOORD_1 (accessor 0) has the wrong type"});
}

TEST_F(GltfTextureTest, WarnsOfCoordinatesThatAreMissing) {
  texture_info()["texCoord"] = 1;
  gltf.primitive_json()["attributes"].erase("TEXCOORD_1");
  gltf.add_node({{"mesh", 0}, {"translation", {0, 0, 5}}});
  expect_warning(
      "mesh 'shape' primitive 0 has no TEXCOORD_1, by which material 'wood' reads textures; they are read at "
      "(0, 0)");
  EXPECT_EQ(load().attributes.at(1).uv1[2], glm::vec2(0));
  texture_info()["texCoord"] = 0;
  gltf.primitive_json()["attributes"].erase("TEXCOORD_0");
  expect_warning(
      "mesh 'shape' primitive 0 has no TEXCOORD_0, by which material 'wood' reads textures; they are read at "
      "(0, 0)");
}

TEST_F(GltfTextureTest, IntegersAreCoordinatesToo) {
  texture_info()["texCoord"] = 1;
  const std::size_t accessor =
      gltf.add_accessor(std::vector<std::uint16_t>{0, 65535, 65535, 0, 0, 0}, "VEC2", kUnsignedShort);
  gltf.json["accessors"][accessor]["normalized"] = true;
  gltf.primitive_json()["attributes"]["TEXCOORD_1"] = accessor;
  EXPECT_EQ(read().uv_set, 1);
  EXPECT_EQ(load().attributes.at(0).uv1[0], glm::vec2(0, 1));
}

// Of an object that is mapped in part the sites take no notice; its textures do.
TEST_F(GltfTextureTest, PartlyMappedObjectsKeepTheirTextures) {
  gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive({0, 0, 1, 1, 0, 1, 0, 1, 1}));
  const Scene scene = load();
  EXPECT_FALSE(scene.objects.at(0).has_uv);
  EXPECT_EQ(scene.triangles.at(0).uv[1], glm::vec2(0.5F, 0));
}

TEST_F(GltfTextureTest, OneWithoutAnImageIsNoTexture) {
  gltf.json["textures"].push_back(nlohmann::json::object());
  texture_info()["index"] = 1;
  expect_warning(
      "material 'wood': baseColorTexture is texture 1, which has no image; the factors alone are used");
  EXPECT_FALSE(load().materials.at(0).texture(TextureSlot::base_color));
}

TEST_F(GltfTextureTest, RefusesBrokenReferences) {
  texture_info()["index"] = 7;
  expect_error({"materials[0].pbrMetallicRoughness.baseColorTexture.index is 7; an index below 1"});
  texture_info() = {{"index", 0}, {"texCoord", -1}};
  expect_error({"baseColorTexture.texCoord is -1; an integer of 0 or more"});
  texture_info() = {{"index", 0}};
  gltf.json["textures"][0]["source"] = 3;
  expect_error({"textures[0].source is 3; an index below 1, the number of images"});
}

TEST_F(GltfTextureTest, TransformsAreTranslationAfterRotationAfterScale) {
  transform() = nlohmann::json::object();
  EXPECT_EQ(read(), Texture());
  transform() = {{"offset", {0.25, -2}}};
  expect_maps({0, 0}, {0.25F, -2});
  expect_maps({1, 1}, {1.25F, -1});
  transform() = {{"scale", {2, -3}}};
  expect_maps({1, 1}, {2, -3});
  // A quarter turn counter-clockwise of an image whose v points down: right becomes up, and down right.
  transform() = {{"rotation", std::acos(-1.0) / 2}};
  expect_maps({1, 0}, {0, -1});
  expect_maps({0, 1}, {1, 0});
  transform() = {{"rotation", std::acos(-1.0) / 2}, {"scale", {2, 3}}, {"offset", {10, 20}}};
  expect_maps({1, 0}, {10, 18});
  expect_maps({0, 1}, {13, 20});
}

TEST_F(GltfTextureTest, ATransformMayChooseOtherCoordinates) {
  transform() = {{"texCoord", 1}};
  EXPECT_EQ(read().uv_set, 1);
  EXPECT_EQ(load().attributes.size(), 1U);
  transform() = {{"texCoord", 5}};
  expect_error({"material 'wood': baseColorTexture has coordinates TEXCOORD_5"});
  transform() = {{"offset", {1}}};
  expect_error({"KHR_texture_transform.offset is an array; an array of 2 numbers"});
}

}  // namespace
}  // namespace qtrace
