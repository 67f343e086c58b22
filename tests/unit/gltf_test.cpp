// What a readable file becomes: container formats, meshes, objects.
#include "engine/gltf/load_gltf.h"
#include "tests/unit/gltf_builder.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace qtrace {
namespace {

using Positions = std::array<glm::vec3, 3>;

const std::vector<float> kSquare{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};  // as a strip: two triangles to +z

glm::vec3 face_normal(const Triangle& t) {
  return glm::normalize(glm::cross(t.position[1] - t.position[0], t.position[2] - t.position[0]));
}

TEST_F(GltfTest, ReadsGlb) {
  gltf.add_triangle();
  const Scene scene = load();
  ASSERT_EQ(scene.triangles.size(), 1U);
  EXPECT_EQ(scene.triangles[0].position, (Positions{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
  EXPECT_EQ(scene.name, "scene");
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfTest, ReadsDataUri) {
  gltf.add_triangle();
  const Scene scene = load("embedded.gltf", gltf.gltf_with(gltf.data_uri()));
  EXPECT_EQ(scene.triangles.at(0).position, (Positions{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
  EXPECT_EQ(scene.name, "embedded");
}

TEST_F(GltfTest, ReadsExternalBufferThatIsLongerThanDeclared) {
  gltf.add_triangle();
  std::filesystem::create_directory(folder.path() / "sub folder");
  folder.write("sub folder/data.bin", gltf.binary + "more");
  const Scene scene = load("scene.gltf", gltf.gltf_with("sub%20folder/data.bin"));
  EXPECT_EQ(scene.triangles.at(0).position, (Positions{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
}

TEST_F(GltfTest, FollowsLinksThatStayInTheFolder) {
  gltf.add_triangle();
  folder.write("data.bin", gltf.binary);
  std::filesystem::create_symlink("data.bin", folder.path() / "link.bin");
  EXPECT_EQ(load("scene.gltf", gltf.gltf_with("./link.bin")).triangles.size(), 1U);
}

TEST_F(GltfTest, IgnoresFurtherChunks) {
  gltf.add_triangle();
  std::string bytes = gltf.glb() + std::string("\4\0\0\0XTRAdata", 12);
  bytes[8] = static_cast<char>(bytes.size() & 0xffU);
  bytes[9] = static_cast<char>(bytes.size() >> 8U);
  EXPECT_EQ(load("scene.glb", bytes).triangles.size(), 1U);
}

TEST_F(GltfTest, ReadsEachIndexType) {
  for (const int type : {kUnsignedByte, kUnsignedShort, kUnsignedInt}) {
    gltf = GltfBuilder();
    nlohmann::json primitive = gltf.primitive(kSquare);
    primitive["indices"] = gltf.add_indices({3, 2, 1, 0, 1, 2}, type);
    gltf.add_node({{"mesh", gltf.add_mesh({primitive})}});
    const Scene scene = load();
    ASSERT_EQ(scene.triangles.size(), 2U) << type;
    EXPECT_EQ(scene.triangles[0].position, (Positions{{{1, 1, 0}, {0, 1, 0}, {1, 0, 0}}})) << type;
    EXPECT_EQ(scene.triangles[1].position, (Positions{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}})) << type;
  }
}

TEST_F(GltfTest, StripKeepsOneSideInFront) {
  nlohmann::json primitive = gltf.primitive({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
  primitive["mode"] = kStrip;
  gltf.add_node({{"mesh", gltf.add_mesh({primitive})}});
  const Scene scene = load();
  ASSERT_EQ(scene.triangles.size(), 3U);
  EXPECT_EQ(scene.triangles[0].position, (Positions{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
  EXPECT_EQ(scene.triangles[1].position, (Positions{{{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}));
  EXPECT_EQ(scene.triangles[2].position, (Positions{{{0, 1, 0}, {1, 1, 0}, {0, 2, 0}}}));
  for (const Triangle& triangle : scene.triangles) EXPECT_EQ(face_normal(triangle), glm::vec3(0, 0, 1));
}

TEST_F(GltfTest, FanTurnsAboutItsFirstVertex) {
  nlohmann::json primitive = gltf.primitive({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0});
  primitive["mode"] = kFan;
  primitive["indices"] = gltf.add_indices({0, 1, 2, 3, 4}, kUnsignedByte);
  gltf.add_node({{"mesh", gltf.add_mesh({primitive})}});
  const Scene scene = load();
  ASSERT_EQ(scene.triangles.size(), 3U);
  EXPECT_EQ(scene.triangles[0].position, (Positions{{{1, 0, 0}, {1, 1, 0}, {0, 0, 0}}}));
  EXPECT_EQ(scene.triangles[2].position, (Positions{{{0, 1, 0}, {-1, 1, 0}, {0, 0, 0}}}));
  for (const Triangle& triangle : scene.triangles) EXPECT_EQ(face_normal(triangle), glm::vec3(0, 0, 1));
}

TEST_F(GltfTest, FaceNormalsWhereTheFileHasNone) {
  gltf.add_node({{"mesh", gltf.add_mesh({gltf.primitive({0, 0, 0, 0, 0, 2, 0, 3, 0})})}});
  const Triangle triangle = load().triangles.at(0);
  for (const glm::vec3& normal : triangle.normal) EXPECT_EQ(normal, glm::vec3(-1, 0, 0));
}

TEST_F(GltfTest, NormalsAreReadAndMadeUnit) {
  gltf.add_triangle();
  gltf.primitive_json()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 9, 3, 0, 4, 0, 0, 1e-30F});
  const Triangle triangle = load().triangles.at(0);
  EXPECT_EQ(triangle.normal[0], glm::vec3(0, 0, 1));
  EXPECT_EQ(triangle.normal[1], glm::vec3(0.6F, 0, 0.8F));
  EXPECT_EQ(triangle.normal[2], glm::vec3(0, 0, 1));
}

TEST_F(GltfTest, ReadsUvOfEachType) {
  gltf.add_triangle();
  const std::vector<std::uint8_t> bytes{0, 0, 0, 255, 255, 51};
  const std::vector<std::uint16_t> shorts{0, 0, 0, 65535, 65535, 13107};
  const std::size_t floats = gltf.add_floats("VEC2", {0, 0, 0, 1, 1, 0.2F});
  for (const std::size_t accessor : {floats, gltf.add_accessor(bytes, "VEC2", kUnsignedByte),
                                     gltf.add_accessor(shorts, "VEC2", kUnsignedShort)}) {
    if (accessor != floats) gltf.json["accessors"][accessor]["normalized"] = true;
    gltf.primitive_json()["attributes"]["TEXCOORD_0"] = accessor;
    const Scene scene = load();
    EXPECT_TRUE(scene.objects.at(0).has_uv);
    EXPECT_EQ(scene.triangles.at(0).uv[1], glm::vec2(0, 1)) << accessor;
    EXPECT_EQ(scene.triangles.at(0).uv[2], glm::vec2(1, 0.2F)) << accessor;
  }
}

TEST_F(GltfTest, WithoutUvTheyAreZero) {
  gltf.add_triangle();
  const Scene scene = load();
  EXPECT_FALSE(scene.objects.at(0).has_uv);
  for (const glm::vec2& uv : scene.triangles.at(0).uv) EXPECT_EQ(uv, glm::vec2(0));
}

TEST_F(GltfTest, ReadsInterleavedAttributes) {
  gltf.add_triangle();
  gltf.binary.clear();
  const std::vector<float> vertices{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 3, 4, 0, 1, 0, 0, 0, 1};
  gltf.add_floats("VEC3", vertices);
  gltf.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 72}, {"byteStride", 24}}};
  const nlohmann::json accessor = {
      {"bufferView", 0}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}};
  gltf.json["accessors"] = {accessor, accessor};
  gltf.json["accessors"][1]["byteOffset"] = 12;
  gltf.primitive_json()["attributes"]["NORMAL"] = 1;
  const Triangle triangle = load().triangles.at(0);
  EXPECT_EQ(triangle.position, (Positions{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
  EXPECT_EQ(triangle.normal[1], glm::vec3(0, 0.6F, 0.8F));
}

TEST_F(GltfTest, OneObjectPerMeshNode) {
  const nlohmann::json triangle = gltf.primitive({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::size_t pair = gltf.add_mesh({triangle, triangle}, "pair");
  const std::size_t unnamed = gltf.add_mesh({triangle});
  gltf.add_node({{"name", "first"}, {"mesh", pair}});
  gltf.add_node({{"mesh", pair}, {"translation", {5, 0, 0}}});
  gltf.add_node({{"mesh", unnamed}});
  const Scene scene = load();
  ASSERT_EQ(scene.objects.size(), 3U);
  const std::vector<std::string> names{"first", "pair", "node 3"};
  const std::vector<std::uint32_t> counts{2, 2, 1};
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scene.objects[i].name, names[i]);
    EXPECT_EQ(scene.objects[i].first_triangle, next);
    EXPECT_EQ(scene.objects[i].triangle_count, counts[i]);
    for (std::uint32_t t = next; t < next + counts[i]; ++t) EXPECT_EQ(scene.triangles[t].object, i);
    next += counts[i];
  }
  EXPECT_EQ(scene.triangles.size(), next);
  EXPECT_EQ(scene.triangles[2].position[0], glm::vec3(5, 0, 0));
}

TEST_F(GltfTest, TakesTheDefaultSceneElseTheFirstElseAllRoots) {
  gltf.add_triangle();
  gltf.json["nodes"].push_back({{"name", "second"}, {"mesh", 0}});
  gltf.json["scenes"].push_back({{"nodes", {0, 2}}});
  gltf.json["scene"] = 1;
  const Scene chosen = load();
  ASSERT_EQ(chosen.objects.size(), 1U);
  EXPECT_EQ(chosen.objects[0].name, "second");
  gltf.json.erase("scene");
  const Scene first = load();
  ASSERT_EQ(first.objects.size(), 1U);
  EXPECT_EQ(first.objects[0].name, "thing");
  gltf.json.erase("scenes");
  EXPECT_EQ(load().objects.size(), 2U);
}

TEST(GltfScenesTest, OwnScenesLoadWithoutWarnings) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(QTRACE_SOURCE_DIR "/configs/scenes")) {
    if (entry.path().extension() != ".glb") continue;
    ++count;
    const Scene scene = load_gltf(entry.path());
    EXPECT_TRUE(scene.warnings.empty()) << entry.path() << ::testing::PrintToString(scene.warnings);
    for (const Object& object : scene.objects) EXPECT_TRUE(object.has_uv) << entry.path() << object.name;
  }
  EXPECT_GE(count, 10U);
}

// The study of light choices rests on it: a lamp per room, each its own object, none far brighter than
// others.
TEST(GltfScenesTest, ManyLightsHasALampInEachOfItsRooms) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/many_lights.glb");
  std::vector<float> powers;
  for (const Object& object : scene.objects) {
    const Triangle& first = scene.triangles[object.first_triangle];
    const glm::vec3 emission = scene.materials[first.material].emission;
    EXPECT_EQ(object.name.starts_with("lamp_"), emission != glm::vec3(0)) << object.name;
    if (emission != glm::vec3(0)) powers.push_back(glm::dot(emission, glm::vec3(0.2126F, 0.7152F, 0.0722F)));
  }
  EXPECT_EQ(powers.size(), 64U);
  const auto [dimmest, brightest] = std::minmax_element(powers.begin(), powers.end());
  EXPECT_LE(*brightest, 3.001F * *dimmest);
  EXPECT_GE(*brightest, 2 * *dimmest);
}

// The dark room lies at z > 0: it must see neither lamp, or next event estimation would find them at once.
TEST(GltfScenesTest, DoorAjarsLampsTurnTheirBacksToTheDarkRoom) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/door_ajar.glb");
  EXPECT_GT(scene.camera.world_from_camera[3].z, 0);
  int emitting = 0;
  for (const Triangle& triangle : scene.triangles) {
    const Material& material = scene.materials[triangle.material];
    if (material.emission == glm::vec3(0)) continue;
    ++emitting;
    EXPECT_FALSE(material.double_sided);
    EXPECT_LT(face_normal(triangle).z, -0.999F);
    for (const glm::vec3& corner : triangle.position) EXPECT_LT(corner.z, -1);
  }
  EXPECT_EQ(emitting, 4);
}

TEST(GltfScenesTest, GlossyRoomHasNoMattSurface) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/glossy_room.glb");
  const auto is_metal = [](const Material& material) { return material.metallic == 1; };
  EXPECT_GE(std::ranges::count_if(scene.materials, is_metal), 3);
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.specular, 1) << material.name;
    EXPECT_GE(material.roughness, 0.099F) << material.name;
    EXPECT_LE(material.roughness, 0.301F) << material.name;
  }
}

TEST(GltfScenesTest, OpenSkyIsMattAndHasNoLightOfItsOwn) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/open_sky.glb");
  ASSERT_FALSE(scene.materials.empty());
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.emission, glm::vec3(0)) << material.name;
    EXPECT_EQ(material.specular, 0) << material.name;
    EXPECT_EQ(material.metallic, 0) << material.name;
  }
}

}  // namespace
}  // namespace qtrace
