// Meshes that do not stand as they are stored: morph targets, skins, instances, hidden nodes.
#include "tests/unit/gltf_builder.h"

#include <array>
#include <cmath>

namespace qtrace {
namespace {

using Corners = std::array<glm::vec3, 3>;

// Node 'thing', 1, shows the triangle (0,0,0) (1,0,0) (0,1,0).
class GltfPoseTest : public GltfTest {
 protected:
  GltfPoseTest() { gltf.add_triangle(); }
  nlohmann::json& node() { return gltf.json["nodes"][1]; }
  nlohmann::json& mesh() { return gltf.json["meshes"][0]; }
  Corners positions(std::size_t triangle = 0) const { return load().triangles.at(triangle).position; }
  void expect_near(const glm::vec3& found, const glm::vec3& wanted) const {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-6F);
  }
};

class GltfMorphTest : public GltfPoseTest {
 protected:
  GltfMorphTest() {
    gltf.primitive_json()["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 2, 0, 0, 2, 0, 0, 2})}},
                                        {{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 4, 0, 0, 0, 0, 0})}}};
  }
};

TEST_F(GltfMorphTest, TargetsAddUpByTheirWeights) {
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}))
      << "weights are 0 unless said";
  mesh()["weights"] = {0.5, 0.25};
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 1), glm::vec3(2, 0, 1), glm::vec3(0, 1, 1)}));
  node()["weights"] = {-1, 0};  // the node's own
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, -2), glm::vec3(1, 0, -2), glm::vec3(0, 1, -2)}));
  EXPECT_TRUE(load().warnings.empty());
}

TEST_F(GltfMorphTest, NormalsMorphToo) {
  gltf.primitive_json()["attributes"]["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  gltf.primitive_json()["targets"][0]["NORMAL"] = gltf.add_floats("VEC3", {1, 0, 0, 0, 0, 0, 0, 0, 0});
  mesh()["weights"] = {1, 0};
  expect_near(load().triangles.at(0).normal[0], {std::sqrt(0.5F), 0, std::sqrt(0.5F)});
  expect_near(load().triangles.at(0).normal[1], {0, 0, 1});
}

TEST_F(GltfMorphTest, RefusesWhatDoesNotFit) {
  mesh()["weights"] = {1};
  expect_error({"mesh 'shape' primitive 0 has 2 morph targets and 1 weights; as many would be right"});
  mesh()["weights"] = {1, "x"};
  expect_error({"meshes[0].weights[1] is \"x\"; a finite number"});
  mesh()["weights"] = {1, 0};
  gltf.primitive_json()["targets"][0]["POSITION"] = gltf.add_floats("VEC3", {0, 0, 2, 0, 0, 2});
  expect_error(
      {"mesh 'shape' primitive 0 target 0 POSITION (accessor", "has a count of 2; 3, as POSITION has"});
  gltf.primitive_json()["targets"][0]["POSITION"] =
      gltf.add_floats("VEC3", {0, 0, HUGE_VALF, 0, 0, 2, 0, 0, 2});
  expect_error({"target 0 POSITION (accessor", "finite numbers would be right"});
}

// Joints 'root', 2, at (0, 0, 10), and 'arm', 3, at (5, 0, 10); the mesh was bound where they stand at z = 0.
class GltfSkinTest : public GltfPoseTest {
 protected:
  GltfSkinTest() {
    gltf.add_node({{"name", "root"}, {"translation", {0, 0, 10}}, {"children", {3}}});
    gltf.json["nodes"].push_back({{"name", "arm"}, {"translation", {5, 0, 0}}});
    std::vector<float> bind(32, 0);
    for (std::size_t joint = 0; joint < 2; ++joint) {
      for (std::size_t i = 0; i < 4; ++i) bind[16 * joint + 5 * i] = 1;
    }
    bind[16 + 12] = -5;  // from the mesh to the arm
    gltf.json["skins"] = {
        {{"name", "bones"}, {"joints", {2, 3}}, {"inverseBindMatrices", gltf.add_floats("MAT4", bind)}}};
    node()["skin"] = 0;
    attributes()["JOINTS_0"] = gltf.add_accessor(
        std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", kUnsignedByte);
    set_weights({1, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0.5F, 0, 0});
  }
  nlohmann::json& attributes() { return gltf.primitive_json()["attributes"]; }
  void set_weights(const std::vector<float>& weights) {
    attributes()["WEIGHTS_0"] = gltf.add_floats("VEC4", weights);
  }
  nlohmann::json& arm() { return gltf.json["nodes"][3]; }
};

TEST_F(GltfSkinTest, VerticesFollowTheirJoints) {
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 10), glm::vec3(1, 0, 10), glm::vec3(0, 1, 10)}));
  arm()["translation"] = {5, 0, 2};
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 10), glm::vec3(1, 0, 12), glm::vec3(0, 1, 11)}));
  node()["translation"] = {100, 100, 100};
  EXPECT_EQ(positions()[0], glm::vec3(0, 0, 10)) << "the node's own transform does not count";
  EXPECT_TRUE(load().warnings.empty());
}

TEST_F(GltfSkinTest, NormalsTurnWithTheirJoints) {
  attributes()["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  gltf.json["nodes"][2]["rotation"] = {0, std::sqrt(0.5), 0, std::sqrt(0.5)};  // z to x
  const Triangle triangle = load().triangles.at(0);
  for (const glm::vec3& normal : triangle.normal) expect_near(normal, {1, 0, 0});
  // A mirrored skeleton keeps the front in front.
  gltf.json["nodes"][2] = {{"name", "root"}, {"scale", {-1, 1, 1}}, {"children", {3}}};
  expect_near(load().triangles.at(0).normal[0], {0, 0, 1});
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 0), glm::vec3(0, 1, 0), glm::vec3(-1, 0, 0)}));
}

TEST_F(GltfSkinTest, WeightsAreMadeToAddUpToOne) {
  set_weights({2, 0, 0, 0, 0, 0.25F, 0, 0, 3, 3, 0, 0});
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 10), glm::vec3(1, 0, 10), glm::vec3(0, 1, 10)}));
  set_weights(std::vector<float>(12, 0));
  expect_error(
      {"mesh 'shape' primitive 0: vertex 0 follows no joint; weights that add up to 1 would be right"});
  set_weights({-1, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
  expect_error({"WEIGHTS_0 (accessor", "element 0 has a weight of -1; 0 or more"});
}

TEST_F(GltfSkinTest, RefusesWhatDoesNotFit) {
  const GltfBuilder good = gltf;
  attributes().erase("WEIGHTS_0");
  expect_error({"mesh 'shape' primitive 0 has JOINTS_0 alone; JOINTS_0 and WEIGHTS_0 belong together"});
  gltf = good;
  attributes()["JOINTS_0"] =
      gltf.add_accessor(std::vector<std::uint8_t>{0, 9, 0, 0, 0, 9, 0, 0, 0, 9, 0, 0}, "VEC4", kUnsignedByte);
  expect_error(
      {"mesh 'shape' primitive 0: vertex 1 follows joint 9 of skin 'bones'; one below 2 would be right"});
  gltf = good;
  gltf.json["skins"][0]["joints"] = {2, 3, 0};
  expect_error({"skin 'bones' inverseBindMatrices (accessor", "has a count of 2; 3, one for each joint"});
  gltf.json["skins"][0]["joints"] = nlohmann::json::array();
  expect_error({"skin 'bones' has no joints"});
  gltf.json["skins"][0].erase("joints");
  expect_error({"skins[0].joints is missing"});
  gltf = good;
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  expect_error({"skin 'bones': its joint 0 is node 'root', which the scene does not have"});
}

TEST_F(GltfPoseTest, InstancesStandWhereTheyAreTold) {
  gltf.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  node()["translation"] = {0, 0, 1};
  const auto half = std::sqrt(0.5F);
  node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", gltf.add_floats("VEC3", {0, 0, 0, 10, 0, 0})},
      {"ROTATION", gltf.add_floats("VEC4", {0, 0, 0, 1, 0, 0, half, half})},  // x to y
      {"SCALE", gltf.add_floats("VEC3", {1, 1, 1, 3, 3, 3})}};
  const Scene scene = load();
  ASSERT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(scene.triangles[0].position[1], glm::vec3(1, 0, 1));
  expect_near(scene.triangles[1].position[0], {10, 0, 1});
  expect_near(scene.triangles[1].position[1], {10, 3, 1});
  EXPECT_EQ(scene.objects.at(1).name, "thing instance 1");
  EXPECT_TRUE(scene.warnings.empty());
  nlohmann::json& attributes = node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  attributes["SCALE"] = gltf.add_floats("VEC3", {1, 1, 1});
  expect_error(
      {"node 'thing' EXT_mesh_gpu_instancing SCALE (accessor", "has a count of 1; 2, as the others have"});
  attributes.erase("SCALE");
  attributes["ROTATION"] = gltf.add_floats("VEC4", {0, 0, 0, 0.5, 0, 0, 0, 1});
  expect_error({"ROTATION (accessor", "element 0 has length 0.5; a unit quaternion"});
  // Instances that differ in what nobody reads stand in one place.
  attributes = {{"_COLOR", gltf.add_floats("VEC3", {1, 0, 0, 0, 1, 0})}};
  EXPECT_EQ(load().triangles.size(), 1U);
  EXPECT_EQ(load().triangles.at(0).position[0].z, 1);
  gltf.json["skins"] = {{{"joints", {0}}}};
  node()["skin"] = 0;
  expect_warning(
      "node 'thing': its mesh has both a skin and instances of EXT_mesh_gpu_instancing; all of these stand "
      "where "
      "the joints are");
}

TEST_F(GltfPoseTest, HiddenNodesHideWhatHangsBelow) {
  gltf.json["extensionsUsed"] = {"KHR_node_visibility"};
  gltf.add_node({{"name", "group"}, {"children", {1}}});
  gltf.add_node({{"mesh", 0}, {"translation", {0, 0, -3}}});
  gltf.json["scenes"][0]["nodes"] = {0, 2, 3};
  EXPECT_EQ(load().triangles.size(), 2U);
  gltf.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = false;
  ASSERT_EQ(load().triangles.size(), 1U);
  EXPECT_EQ(positions()[0].z, -3);
  EXPECT_TRUE(load().warnings.empty());
  gltf.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(load().triangles.size(), 2U);
  gltf.json["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = 0;
  expect_error({"nodes[2].extensions.KHR_node_visibility.visible is 0; true or false"});
}

}  // namespace
}  // namespace qtrace
