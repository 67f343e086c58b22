// Images of glTF files: where they stand, and which of them are read.
#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "tests/unit/gltf_builder.h"
#include "tests/unit/picture_files.h"

namespace qtrace {
namespace {

const std::string kRed = png_of(255, 0, 0), kBlue = png_of(0, 0, 255, 128);

class GltfImageTest : public GltfTest {
 protected:
  GltfImageTest() {
    gltf.add_triangle();
    gltf.primitive_json()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
    gltf.material()["name"] = "wood";
  }
  void set_base_color(std::size_t texture) {
    gltf.material()["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture;
  }
  // The file with one image, at a URI.
  void set_uri(const std::string& uri) {
    gltf.json["images"] = {{{"name", "bark"}, {"uri", uri}}};
    gltf.json["textures"] = {{{"source", 0}}};
    set_base_color(0);
  }
  static std::string base64(const std::string& bytes) {
    GltfBuilder builder;
    builder.binary = bytes;
    const std::string uri = builder.data_uri();
    return uri.substr(uri.find(',') + 1);
  }
  void expect_one(const TextureImage::Texel& texel) {
    const Scene scene = load();
    EXPECT_TRUE(scene.warnings.empty()) << ::testing::PrintToString(scene.warnings);
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].texels, std::vector<TextureImage::Texel>{texel});
    ASSERT_TRUE(scene.materials.at(0).texture(TextureSlot::base_color));
    EXPECT_EQ(scene.materials[0].texture(TextureSlot::base_color)->image, 0U);
  }
  void expect_none() {
    const Scene scene = load();
    EXPECT_TRUE(scene.images.empty());
    for (const auto& texture : scene.materials.at(0).textures) EXPECT_FALSE(texture);
  }
};

TEST_F(GltfImageTest, StandsInABufferView) {
  set_base_color(gltf.add_texture(kBlue));
  expect_one({0, 0, 0xffff, 128 * 257});
  EXPECT_EQ(load().images[0].name, "image 0");
}

TEST_F(GltfImageTest, StandsInAFileBesideTheScene) {
  std::filesystem::create_directory(folder.path() / "wood");
  folder.write("wood/the bark.png", kRed);
  set_uri("wood/the%20bark.png");
  expect_one({0xffff, 0, 0, 0xffff});
  EXPECT_EQ(load().images[0].name, "bark");
  set_uri("wood/missing.png");
  expect_error({"image 'bark': 'wood/missing.png': there is no such file"});
  set_uri("../bark.png");
  expect_error({"image 'bark': '../bark.png' leaves the scene's folder; a file inside it would be right"});
  set_uri("http://example.org/bark.png");
  expect_error({"image 'bark': 'http://example.org/bark.png' is not the path of a file"});
  set_uri("wood");
  expect_error({"image 'bark': 'wood': this is not a regular file"});
}

TEST_F(GltfImageTest, StandsInADataUri) {
  set_uri("data:image/png;base64," + base64(kRed));
  expect_one({0xffff, 0, 0, 0xffff});
  set_uri("data:application/octet-stream;base64," + base64(kRed));
  expect_one({0xffff, 0, 0, 0xffff});
  set_uri("data:image/png;base64,%%%");
  expect_error({"image 'bark': "});
  set_uri("data:image/webp;base64," + base64(kRed));
  const Scene scene = load();
  EXPECT_EQ(scene.images.size(), 1U);
  EXPECT_EQ(scene.warnings.size(), 2U) << ::testing::PrintToString(scene.warnings);
}

TEST_F(GltfImageTest, ItsBytesSayWhatItIs) {
  set_base_color(gltf.add_texture(kRed, "image/jpeg"));
  expect_warning("image 0 is called image/jpeg and is image/png; it is read as what it is");
  gltf.json["images"][0].erase("mimeType");
  expect_one({0xffff, 0, 0, 0xffff});
  set_base_color(gltf.add_texture(jpeg({.width = 8, .height = 8}, std::string(192, '\x80')), "image/jpeg"));
  EXPECT_EQ(load().images.at(0).width, 8U);
}

TEST_F(GltfImageTest, RefusesWhatIsBrokenByItsName) {
  set_base_color(gltf.add_texture(kRed.substr(0, kRed.size() - 20)));
  gltf.json["images"][0]["name"] = "bark";
  expect_error({"image 'bark': the PNG cannot be decoded: "});
  gltf.json["images"][0]["bufferView"] = 0;
  expect_error({"image 'bark': its bytes are no picture that is known; PNG or JPEG would be right"});
  gltf.json["images"][0].erase("bufferView");
  expect_error({"image 'bark' has neither uri and bufferView; one of them would be right"});
  gltf.json["images"][0] = {{"bufferView", 0}, {"uri", "a.png"}, {"mimeType", "image/png"}};
  expect_error({"image 0 has both uri and bufferView; one of them would be right"});
  gltf.json["images"][0] = {{"uri", 5}};
  expect_error({"images[0].uri is 5; a string would be right"});
}

TEST_F(GltfImageTest, WhatNobodyReadsIsNotOpened) {
  const nlohmann::json texture = {{"index", 0}};
  set_uri("../../missing.png");
  gltf.material() = {{"occlusionTexture", texture}, {"emissiveTexture", texture}};
  nlohmann::json& extensions = gltf.material()["extensions"];
  extensions["KHR_materials_specular"] = {
      {"specularFactor", 0}, {"specularTexture", texture}, {"specularColorTexture", texture}};
  extensions["KHR_materials_transmission"] = {{"transmissionFactor", 0}, {"transmissionTexture", texture}};
  extensions["KHR_materials_clearcoat"] = {{"clearcoatTexture", texture},
                                           {"clearcoatNormalTexture", texture}};
  expect_none();
  gltf.material()["emissiveFactor"] = {0, 1, 0};
  expect_error({"missing.png"});
  gltf.material() = {{"normalTexture", texture}};
  expect_error({"missing.png"});
  gltf.material()["extensions"]["KHR_materials_unlit"] = nlohmann::json::object();
  expect_none();
  gltf.json["materials"].push_back({{"normalTexture", texture}});
  EXPECT_TRUE(load().images.empty()) << "no primitive has the second material";
}

TEST_F(GltfImageTest, EqualOnesAreOne) {
  const std::size_t red = gltf.add_texture(kRed), again = gltf.add_texture(kRed),
                    blue = gltf.add_texture(kBlue);
  set_base_color(red);
  gltf.material()["normalTexture"]["index"] = again;
  gltf.material()["emissiveTexture"]["index"] = blue;
  gltf.material()["emissiveFactor"] = {1, 1, 1};
  const Scene scene = load();
  EXPECT_EQ(scene.images.size(), 2U);
  EXPECT_EQ(scene.materials[0].texture(TextureSlot::base_color)->image, 0U);
  EXPECT_EQ(scene.materials[0].texture(TextureSlot::normal)->image, 0U);
  EXPECT_EQ(scene.materials[0].texture(TextureSlot::emission)->image, 1U);
}

TEST_F(GltfImageTest, TexelsAreLimited) {
  set_base_color(
      gltf.add_texture(png({.width = 4, .height = 4, .color = PngColor::grey}, std::string(16, 'a'))));
  gltf.material()["normalTexture"]["index"] =
      gltf.add_texture(png({.width = 4, .height = 2, .color = PngColor::grey}, std::string(8, 'b')));
  const std::string bytes = gltf.glb();
  const auto parse = [&](std::size_t most) {
    SceneLimits limits;
    limits.texels = most;
    return parse_gltf({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, "a.glb", {},
                      limits);
  };
  EXPECT_EQ(parse(24).images.size(), 2U);
  try {
    parse(23);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "a.glb: image 1 has 4 x 2 texels, and all images together more than 23, which is the most "
                 "supported");
  }
}

// The images of these need decoders of their own; beside them a texture may name another.
TEST_F(GltfImageTest, OtherKindsNeedAnotherInTheirPlace) {
  for (const char* name : {"EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu"}) {
    gltf.json["extensionsUsed"] = {name};
    gltf.json["images"] = {{{"uri", "missing.webp"}}};
    gltf.json["textures"] = {{{"extensions", {{name, {{"source", 0}}}}}}};
    set_base_color(0);
    expect_error({fmt::format("texture 0, which material 'wood' reads, has its image by {} alone", name)});
    gltf.material().erase("pbrMetallicRoughness");
    expect_none();
    gltf.add_texture(kRed);
    gltf.json["textures"][0]["source"] = 1;
    set_base_color(0);
    expect_warning(fmt::format("extension {} is not modelled; the scene is read without it", name));
    EXPECT_EQ(load().images.size(), 1U);
  }
}

TEST_F(GltfImageTest, BuffersThatServeNoImageAreNotOpenedForIt) {
  folder.write("bark.png", kRed);
  set_uri("bark.png");
  gltf.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 4}});
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}}, {{"byteLength", 4}, {"uri", "missing.bin"}}};
  expect_one({0xffff, 0, 0, 0xffff});
}

}  // namespace
}  // namespace qtrace
