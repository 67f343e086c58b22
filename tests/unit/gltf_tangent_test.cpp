// Tangents for textures of normals: from the file, or from texture coordinates.
#include "tests/unit/gltf_builder.h"
#include "tests/unit/picture_files.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace qtrace {
namespace {

class GltfTangentTest : public GltfTest {
 protected:
  GltfTangentTest() {
    gltf.add_triangle();
    attributes()["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    gltf.material()["normalTexture"]["index"] = gltf.add_texture(png_of(128, 128, 255));
  }
  nlohmann::json& attributes() { return gltf.primitive_json()["attributes"]; }
  void set_uv(const std::vector<float>& uv) { attributes()["TEXCOORD_0"] = gltf.add_floats("VEC2", uv); }
  void set_tangents(const glm::vec4& t) {
    attributes()["TANGENT"] =
        gltf.add_floats("VEC4", {t.x, t.y, t.z, t.w, t.x, t.y, t.z, t.w, t.x, t.y, t.z, t.w});
  }
  std::vector<glm::vec4> tangents() {
    const Scene scene = load();
    std::vector<glm::vec4> all;
    for (const Triangle& triangle : scene.triangles) {
      const TriangleAttributes& attributes = scene.attributes.at(triangle.attributes);
      for (std::size_t i = 0; i < 3; ++i) {
        all.push_back(attributes.tangent[i]);
        EXPECT_NEAR(glm::length(glm::vec3(all.back())), 1, 1e-6);
        EXPECT_NEAR(glm::dot(glm::vec3(all.back()), triangle.normal[i]), 0, 1e-6);
        EXPECT_EQ(std::abs(all.back().w), 1);
      }
    }
    return all;
  }
  static void expect_near(const glm::vec4& found, const glm::vec4& expected) {
    EXPECT_NEAR(glm::distance(found, expected), 0, 1e-6)
        << ::testing::PrintToString(std::array{found.x, found.y, found.z, found.w});
  }
  void expect_all(const glm::vec4& expected) {
    for (const glm::vec4& found : tangents()) expect_near(found, expected);
  }
};

// The image stands upright on the triangle: u to the right, v downwards.
const std::vector<float> kUpright{0, 1, 1, 1, 0, 0};

TEST_F(GltfTangentTest, LieAlongGrowingU) {
  set_uv(kUpright);
  expect_all({1, 0, 0, 1});
  set_uv({0, 0, 0, 1, 1, 0});  // turned: u upwards, v to the right
  expect_all({0, 1, 0, 1});
  set_uv({1, 1, 0, 1, 1, 0});  // seen in a mirror: u to the left
  expect_all({-1, 0, 0, -1});
  set_uv({0, 0, 1, 0, 0, 1});  // upside down and mirrored: v upwards
  expect_all({1, 0, 0, -1});
}

// w cross(normal, tangent) goes where v falls, for any triangle in any place.
TEST_F(GltfTangentTest, TheThirdAxisIsUpInTheImage) {
  std::uint32_t state = 1;
  const auto random = [&state] {
    return static_cast<float>((state = state * 1664525U + 1013904223U) >> 8U) / 0x1p23F - 1;
  };
  attributes().erase("NORMAL");
  for (int i = 0; i < 20; ++i) {
    std::vector<float> positions, uv;
    for (int k = 0; k < 9; ++k) positions.push_back(random());
    for (int k = 0; k < 6; ++k) uv.push_back(random());
    attributes()["POSITION"] = gltf.add_floats("VEC3", positions);
    set_uv(uv);
    gltf.json["nodes"][1]["scale"] = {random(), random(), random()};
    const Scene scene = load();
    const Triangle& t = scene.triangles.at(0);
    const glm::vec3 a = t.position[1] - t.position[0], b = t.position[2] - t.position[0];
    const glm::vec2 c = t.uv[1] - t.uv[0], d = t.uv[2] - t.uv[0];
    // The gradients of u and v over the triangle.
    const glm::vec3 n = glm::cross(a, b), of_a = glm::cross(b, n), of_b = glm::cross(n, a);
    const glm::vec3 u_grows = c.x * of_a + d.x * of_b, v_grows = c.y * of_a + d.y * of_b;
    const glm::vec4 tangent = tangents().at(0);
    EXPECT_NEAR(glm::dot(glm::vec3(tangent), glm::normalize(v_grows)), 0, 1e-4) << "v stays along it";
    EXPECT_GT(glm::dot(glm::vec3(tangent), u_grows), 0);
    EXPECT_LT(glm::dot(tangent.w * glm::cross(t.normal[0], glm::vec3(tangent)), v_grows), 0);
  }
}

// A file's own tangents come out as those that follow from its coordinates, however the node stands.
TEST_F(GltfTangentTest, TheFilesMoveWithTheNode) {
  set_uv(kUpright);
  const std::vector<std::vector<float>> scales{{1, 1, 1},  {-1, 1, 1},   {1, -1, 1},
                                               {1, 1, -1}, {-1, -1, -1}, {2, 2, 2}};
  for (const auto& scale : scales) {
    for (const std::vector<double>& rotation :
         {std::vector<double>{0, 0, 0, 1}, {0.5, 0.5, 0.5, 0.5}, {0.6, 0, 0, 0.8}}) {
      gltf.json["nodes"][1]["scale"] = scale;
      gltf.json["nodes"][1]["rotation"] = rotation;
      attributes().erase("TANGENT");
      const std::vector<glm::vec4> generated = tangents();
      set_tangents({1, 0, 0, 1});
      const std::vector<glm::vec4> read = tangents();
      for (std::size_t i = 0; i < 3; ++i) expect_near(read.at(i), generated.at(i));
    }
  }
}

TEST_F(GltfTangentTest, TheFilesComeFirstAndAreMadePerpendicular) {
  set_uv(kUpright);
  set_tangents({0, 2, 0.5F, -1});
  expect_all({0, 1, 0, -1});
  set_tangents({0, 0, 0, 1});
  EXPECT_EQ(tangents().size(), 3U) << "any direction will do";
  set_tangents({0, 1, 0, 1});
  attributes().erase("NORMAL");
  expect_all({1, 0, 0, 1});  // which glTF has ignored without normals
}

TEST_F(GltfTangentTest, MorphTargetsTurnThem) {
  set_uv(kUpright);
  set_tangents({1, 0, 0, 1});
  gltf.primitive_json()["targets"] = {{{"TANGENT", gltf.add_floats("VEC3", {0, 1, 0, 0, 1, 0, 0, 1, 0})}}};
  gltf.json["meshes"][0]["weights"] = {1};
  expect_all({std::sqrt(0.5F), std::sqrt(0.5F), 0, 1});
}

// Two triangles with tangents (1, 0) and (1, 1) meet in a corner with 90 and 45 degrees.
TEST_F(GltfTangentTest, AreAveragedByAngles) {
  attributes()["POSITION"] = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 1, 0});
  attributes()["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  set_uv({0, 0, 1, 0, 0, -1, -1, -2});
  gltf.primitive_json()["indices"] = gltf.add_indices({0, 1, 2, 0, 2, 3});
  const glm::vec2 slope = glm::normalize(glm::vec2(1, 1));
  const glm::vec2 at_origin = glm::normalize(90.0F * glm::vec2(1, 0) + 45.0F * slope);
  const glm::vec2 above = glm::normalize(45.0F * glm::vec2(1, 0) + 90.0F * slope);
  const std::vector<glm::vec4> found = tangents();
  expect_near(found.at(0), {at_origin, 0, 1});
  expect_near(found.at(1), {1, 0, 0, 1});
  expect_near(found.at(2), {above, 0, 1});
  expect_near(found.at(3), {at_origin, 0, 1});
  expect_near(found.at(4), {above, 0, 1});
  expect_near(found.at(5), {slope, 0, 1});
}

TEST_F(GltfTangentTest, MirroredHalvesAreNotAveraged) {
  attributes()["POSITION"] = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0});
  attributes()["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  set_uv({0, 1, 1, 1, 0, 0, 1, 1});  // u is the distance from the middle
  gltf.primitive_json()["indices"] = gltf.add_indices({0, 1, 2, 0, 2, 3});
  const std::vector<glm::vec4> found = tangents();
  for (std::size_t i = 0; i < 3; ++i) expect_near(found.at(i), {1, 0, 0, 1});
  for (std::size_t i = 3; i < 6; ++i) expect_near(found.at(i), {-1, 0, 0, -1});
}

TEST_F(GltfTangentTest, WhereCoordinatesCoverNothingNeighboursSayOrNobody) {
  set_uv({0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F});
  EXPECT_EQ(tangents().size(), 3U);
  attributes().erase("TEXCOORD_0");
  EXPECT_EQ(tangents().size(), 3U);
  attributes()["POSITION"] = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0});
  attributes()["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  set_uv({0, 0, 0, 1, 1, 0, 2, 0});  // turned, and the other triangle on a line
  gltf.primitive_json()["indices"] = gltf.add_indices({0, 1, 2, 0, 2, 3});
  const std::vector<glm::vec4> found = tangents();
  for (std::size_t i = 0; i < 5; ++i) expect_near(found.at(i), {0, 1, 0, 1});
}

TEST_F(GltfTangentTest, FollowTheCoordinatesOfTheirTextureWithoutItsTransform) {
  set_uv(kUpright);
  attributes()["TEXCOORD_1"] = gltf.add_floats("VEC2", {0, 0, 0, 1, 1, 0});
  gltf.material()["normalTexture"]["texCoord"] = 1;
  expect_all({0, 1, 0, 1});
  gltf.material()["normalTexture"]["texCoord"] = 0;
  gltf.json["extensionsUsed"] = {"KHR_texture_transform"};
  gltf.material()["normalTexture"]["extensions"]["KHR_texture_transform"]["rotation"] = 1;
  expect_all({1, 0, 0, 1});
}

TEST_F(GltfTangentTest, CoatsHaveNormalsToo) {
  set_uv(kUpright);
  const nlohmann::json texture = gltf.material()["normalTexture"];
  gltf.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", texture}}}};
  EXPECT_TRUE(load().attributes.empty()) << "nobody asks for tangents";
  gltf.material()["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1},
                                                              {"clearcoatNormalTexture", texture}};
  gltf.json["extensionsUsed"] = {"KHR_materials_clearcoat"};
  expect_all({1, 0, 0, 1});
}

TEST_F(GltfTangentTest, WhatNoTextureNeedsMayBeBroken) {
  set_uv(kUpright);
  attributes()["TANGENT"] = attributes()["NORMAL"];  // VEC3
  expect_error({"mesh 'shape' primitive 0 TANGENT (accessor 1) has the wrong type"});
  gltf.material().erase("normalTexture");
  EXPECT_TRUE(load().attributes.empty());
}

}  // namespace
}  // namespace qtrace
