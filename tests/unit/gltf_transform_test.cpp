// Node transforms and the camera.
#include "tests/unit/gltf_builder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace qtrace {
namespace {

const double kHalf = std::sqrt(0.5);  // of a rotation by 90 degrees: sine and cosine of its half

void expect_near(const glm::vec3& actual, const glm::vec3& expected) {
  EXPECT_LT(glm::distance(actual, expected), 1e-5F)
      << actual.x << ' ' << actual.y << ' ' << actual.z << " is not " << expected.x << ' ' << expected.y
      << ' ' << expected.z;
}

class GltfTransformTest : public GltfTest {
 protected:
  GltfTransformTest() { gltf.add_triangle(); }
  nlohmann::json& node() { return gltf.json["nodes"][1]; }
  nlohmann::json& camera_node() { return gltf.json["nodes"][0]; }
  nlohmann::json& perspective() { return gltf.json["cameras"][0]["perspective"]; }
  void add_normals(const std::vector<float>& normals) {
    gltf.primitive_json()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", normals);
  }
  // A parent for the node of the triangle.
  void add_parent(nlohmann::json parent) {
    parent["children"] = {1};
    gltf.add_node(std::move(parent));
    gltf.json["scenes"][0]["nodes"] = {0, 2};
  }
};

TEST_F(GltfTransformTest, ScalesThenRotatesThenTranslates) {
  node()["translation"] = {10, 20, 30};
  node()["rotation"] = {0, 0, kHalf, kHalf};  // x to y
  node()["scale"] = {2, 3, 4};
  const Triangle triangle = load().triangles.at(0);
  expect_near(triangle.position[0], {10, 20, 30});
  expect_near(triangle.position[1], {10, 22, 30});
  expect_near(triangle.position[2], {7, 20, 30});
}

TEST_F(GltfTransformTest, MatrixIsColumnMajor) {
  node()["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1};
  const Triangle triangle = load().triangles.at(0);
  expect_near(triangle.position[1], {10, 22, 30});
  expect_near(triangle.position[2], {7, 20, 30});
}

TEST_F(GltfTransformTest, ParentsApplyAfterChildren) {
  node()["translation"] = {1, 0, 0};
  add_parent({{"rotation", {0, 0, kHalf, kHalf}}, {"translation", {0, 0, 5}}});
  expect_near(load().triangles.at(0).position[0], {0, 1, 5});
}

TEST_F(GltfTransformTest, NormalsGoByInverseTranspose) {
  add_normals({0.6F, 0, 0.8F, 0.6F, 0, 0.8F, 0.6F, 0, 0.8F});
  camera_node()["translation"] = {0, 0, 3};
  node()["scale"] = {1, 1, 4};                // n goes to (0.6, 0, 0.8 / 4) but for its length
  node()["rotation"] = {0, kHalf, 0, kHalf};  // (x, y, z) to (z, y, -x)
  const Scene scene = load();
  EXPECT_EQ(scene.warnings, std::vector<std::string>{});
  for (const glm::vec3& normal : scene.triangles.at(0).normal) {
    expect_near(normal, glm::normalize(glm::vec3(0.2F, 0, -0.6F)));
  }
}

TEST_F(GltfTransformTest, MirroringKeepsTheFrontCounterClockwise) {
  add_normals({0, 0, 1, 0, 0, 1, 0, 0, 1});
  gltf.primitive_json()["attributes"]["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
  node()["scale"] = {-2, 1, 1};
  const Scene scene = load();
  const Triangle& triangle = scene.triangles.at(0);
  expect_near(triangle.position[1], {0, 1, 0});
  expect_near(triangle.position[2], {-2, 0, 0});
  EXPECT_EQ(triangle.uv[1], glm::vec2(0, 1));
  EXPECT_EQ(triangle.uv[2], glm::vec2(1, 0));
  for (const glm::vec3& normal : triangle.normal) expect_near(normal, {0, 0, 1});
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfTransformTest, MirroringThroughTheFaceTurnsItsNormals) {
  add_normals({0, 0, 1, 0, 0, 1, 0, 0, 1});
  node()["scale"] = {1, 1, -1};
  const Scene scene = load();
  for (const glm::vec3& normal : scene.triangles.at(0).normal) expect_near(normal, {0, 0, -1});
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfTransformTest, FlattenedMeshKeepsFiniteNormals) {
  add_normals({0, 0, 1, 1, 0, 0, 0.6F, 0, 0.8F});
  node()["scale"] = {1, 1, 0};
  const Triangle triangle = load().triangles.at(0);
  for (const glm::vec3& normal : triangle.normal) expect_near(normal, {0, 0, 1});
}

TEST_F(GltfTransformTest, DeepHierarchyNeedsNoDeepStack) {
  constexpr std::size_t kDepth = 100000;
  nlohmann::json& nodes = gltf.json["nodes"];
  for (std::size_t i = 0; i < kDepth; ++i) nodes.push_back({{"children", {nodes.size() + 1}}});
  nodes.push_back({{"mesh", 0}, {"name", "deep"}});
  gltf.json["scenes"][0]["nodes"] = {0, 2};
  EXPECT_EQ(load().objects.at(0).name, "deep");
}

TEST_F(GltfTransformTest, CameraLosesItsScale) {
  camera_node().erase("camera");
  camera_node()["children"] = {2};
  camera_node()["scale"] = {2, 3, 4};
  camera_node()["translation"] = {1, 2, 3};
  gltf.json["nodes"].push_back(
      {{"camera", 0}, {"rotation", {0, kHalf, 0, kHalf}}, {"translation", {1, 1, 1}}});
  const Camera camera = load().camera;
  expect_near(camera.world_from_camera[0], {0, 0, -1});
  expect_near(camera.world_from_camera[1], {0, 1, 0});
  expect_near(camera.world_from_camera[2], {1, 0, 0});
  expect_near(camera.world_from_camera[3], {3, 5, 7});
  EXPECT_EQ(camera.world_from_camera[3][3], 1.0F);
  EXPECT_EQ(camera.vertical_fov, 0.5F);
}

TEST_F(GltfTransformTest, ShearedCameraKeepsItsDirection) {
  camera_node()["matrix"] = {1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 2, 0, 0, 0, 0, 1};
  const Camera camera = load().camera;
  expect_near(camera.world_from_camera[0], {1, 0, 0});
  expect_near(camera.world_from_camera[1], {0, 1, 0});
  expect_near(camera.world_from_camera[2], {0, 0, 1});
}

TEST_F(GltfTransformTest, RefusesMirroredAndFlatCameras) {
  camera_node()["scale"] = {-1, 1, 1};
  expect_error({"node 'eye': the camera is mirrored"});
  camera_node()["scale"] = {1, 1, 0};
  expect_error({"node 'eye': the camera is squeezed flat"});
  camera_node()["scale"] = {0, 1, 1};
  expect_error({"node 'eye': the camera is squeezed flat"});
}

TEST_F(GltfTransformTest, RefusesOtherCameras) {
  perspective()["yfov"] = 0;
  expect_error({"camera 0 at node 'eye': yfov is 0", "between 0 and pi"});
  perspective()["yfov"] = glm::pi<double>();
  expect_error({"yfov is 3.14"});
  perspective()["yfov"] = -1;
  expect_error({"yfov is -1"});
  perspective().erase("yfov");
  expect_error({"cameras[0].perspective.yfov is missing"});
  gltf.json["cameras"][0].erase("perspective");
  expect_error({"cameras[0].perspective is missing"});
}

TEST_F(GltfTransformTest, FurtherCamerasAreIgnored) {
  gltf.add_node({{"name", "other"}, {"camera", 0}, {"translation", {9, 9, 9}}});
  expect_warning("node 'other' holds a further camera, which is ignored; node 'eye' is used");
  EXPECT_EQ(load().camera.world_from_camera[3], glm::vec4(0, 0, 0, 1));
}

TEST_F(GltfTransformTest, RefusesNodesThatFormNoTree) {
  add_parent({{"name", "parent"}});
  camera_node()["children"] = {1};
  expect_error({"node 'thing' is a child of node 'eye' and again of node 'parent'"});
  camera_node().erase("children");
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  expect_error({"the scene lists node 'thing', but not its parent node 'parent'"});
  gltf.json["scenes"][0]["nodes"] = {0, 2, 2};
  expect_error({"the scene lists node 'parent' twice"});
  gltf.json["scenes"][0]["nodes"] = {0, 2};
  gltf.json["nodes"][2].erase("children");
  node()["children"] = {1};
  expect_error({"node 'thing' is its own ancestor"});
}

TEST_F(GltfTransformTest, ANodeThatIsListedBesideItsAncestorIsReadOnce) {
  add_parent({{"name", "parent"}, {"translation", {0, 0, 7}}});
  gltf.json["scenes"][0]["nodes"] = {1, 0, 2};
  expect_warning("the scene lists node 'thing' beside an ancestor, which brings it anyway; it is read once");
  EXPECT_EQ(load().triangles.size(), 1U);
  EXPECT_EQ(load().triangles.at(0).position[0].z, 7);
}

TEST_F(GltfTransformTest, RotationsOfNearlyUnitLengthAreNormalised) {
  const Triangle exact = load().triangles.at(0);
  for (const double length : {0.99, 0.998, 1.01}) {
    node()["rotation"] = {0, 0, 0, length};
    expect_warning(
        fmt::format("node 'thing': the rotation has length {} in place of 1; it is normalised", length));
    EXPECT_EQ(load().triangles.at(0).position, exact.position);
  }
  node()["rotation"] = {0, 0, 0, 0.9999};
  EXPECT_TRUE(load().warnings.empty());
  node()["rotation"] = {0, 0, 0, 0.985};
  expect_error({"node 'thing': the rotation has length 0.985"});
}

TEST_F(GltfTransformTest, RoundedMatricesAreAffine) {
  node() = {{"name", "thing"}, {"mesh", 0}};
  node()["matrix"] = {1, 0, 0, 0, 0, 1, 0, 1e-7, 0, 0, 1, 0, 0, 0, 5, 0.99999994};
  expect_warning("node 'thing': the matrix's last row is 0 1e-07 0 0.99999994; it is read as 0 0 0 1");
  EXPECT_EQ(load().triangles.at(0).position[2], glm::vec3(0, 1, 5));
}

TEST_F(GltfTransformTest, RefusesUnusableTransforms) {
  node()["rotation"] = {0, 0, 0, 0.9};
  expect_error({"node 'thing': the rotation has length 0.9", "unit quaternion"});
  node()["rotation"] = {0, 0, 0, 0};
  expect_error({"node 'thing': the rotation has length 0"});
  node() = {{"name", "thing"}, {"mesh", 0}, {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  expect_error({"node 'thing': the matrix is not affine"});
  node()["translation"] = {0, 0, 1};
  expect_error({"nodes[1] has a matrix beside translation"});
}

TEST_F(GltfTransformTest, RefusesNumbersThatAreNotFinite) {
  node()["translation"] = {0, std::nan(""), 0};  // written as null
  expect_error({"nodes[1].translation holds null", "finite numbers"});
  node()["translation"] = {0, 1e39, 0};
  expect_error({"nodes[1].translation holds 1e+39"});
  node()["translation"] = {0, 1};
  expect_error({"nodes[1].translation is an array; an array of 3 numbers"});
  std::string text = gltf.gltf_with("x.bin");
  text.replace(text.find("[0,1]"), 5, "[0,1e999,0]");
  expect_error(folder.write("scene.gltf", text), {"the JSON is not valid", "1e999"});
}

TEST_F(GltfTransformTest, RefusesOverflowInWorldSpace) {
  node()["scale"] = {1e30, 1, 1};
  add_parent({{"scale", {1e30, 1, 1}}});
  expect_error({"node 'thing': its world transform overflows"});
  gltf.json["nodes"][2]["scale"] = {1, 1, 1};
  gltf.json["meshes"] = nlohmann::json::array();
  gltf.add_mesh({gltf.primitive({0, 0, 0, 1e30F, 0, 0, 0, 1, 0})}, "huge");
  expect_error({"object 'thing': vertex 1 of mesh 'huge' primitive 0 overflows in world space"});
}

}  // namespace
}  // namespace qtrace
