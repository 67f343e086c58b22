// Lights that no surface has (KHR_lights_punctual).
#include "tests/unit/gltf_builder.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace qtrace {
namespace {

class GltfLightTest : public GltfTest {
 protected:
  GltfLightTest() {
    gltf.add_triangle();
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_lights_punctual"};
  }
  void add_light(const nlohmann::json& light) {
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"].push_back(light);
  }
  nlohmann::json& light() { return gltf.json["extensions"]["KHR_lights_punctual"]["lights"][0]; }
  nlohmann::json& add_node(nlohmann::json node, std::size_t light = 0) {
    node["extensions"]["KHR_lights_punctual"]["light"] = light;
    return gltf.json["nodes"][gltf.add_node(std::move(node))];
  }
  std::vector<PunctualLight> read() {
    const Scene scene = load();
    EXPECT_TRUE(scene.warnings.empty()) << ::testing::PrintToString(scene.warnings);
    return scene.lights;
  }
};

TEST_F(GltfLightTest, TakesTheDefaultsOfTheExtension) {
  add_light({{"type", "point"}});
  add_node({});
  const std::vector<PunctualLight> lights = read();
  ASSERT_EQ(lights.size(), 1U);
  EXPECT_EQ(lights[0].name, "light 0");
  EXPECT_EQ(lights[0].kind, PunctualLight::Kind::point);
  EXPECT_EQ(lights[0].intensity, glm::vec3(1));
  EXPECT_EQ(lights[0].range, std::numeric_limits<float>::infinity());
  light() = {{"type", "spot"}, {"spot", nlohmann::json::object()}};
  EXPECT_EQ(read()[0].inner_cone_angle, 0);
  EXPECT_FLOAT_EQ(read()[0].outer_cone_angle, std::acos(-1.0F) / 4);
}

TEST_F(GltfLightTest, ReadsEveryNumber) {
  add_light({{"name", "lamp"},
             {"type", "spot"},
             {"color", {0.25, 0.5, 1}},
             {"intensity", 20},
             {"range", 7},
             {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
  add_node({});
  const PunctualLight lamp = read().at(0);
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.kind, PunctualLight::Kind::spot);
  EXPECT_EQ(lamp.intensity, glm::vec3(5, 10, 20));
  EXPECT_EQ(lamp.range, 7);
  EXPECT_EQ(lamp.inner_cone_angle, 0.25F);
  EXPECT_EQ(lamp.outer_cone_angle, 0.5F);
}

// A light stands where its nodes put it and shines along their -z; scales move it and change nothing else.
TEST_F(GltfLightTest, NodesPlaceThem) {
  add_light({{"type", "spot"}, {"spot", nlohmann::json::object()}});
  add_light({{"type", "directional"}, {"range", 3}});
  add_node({{"translation", {1, 2, 3}}});
  // A quarter turn about y brings -z to -x; the parent stretches and moves.
  const std::size_t child = gltf.json["nodes"].size();
  gltf.json["nodes"].push_back(
      {{"translation", {1, 0, 0}}, {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}});
  gltf.json["nodes"][child]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  gltf.add_node({{"scale", {5, 2, 2}}, {"translation", {0, 10, 0}}, {"children", {child}}});
  add_node({{"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}, {"translation", {9, 9, 9}}}, 1);
  const std::vector<PunctualLight> lights = read();
  ASSERT_EQ(lights.size(), 3U);
  EXPECT_EQ(lights[0].position, glm::vec3(1, 2, 3));
  EXPECT_EQ(lights[0].direction, glm::vec3(0, 0, -1));
  EXPECT_EQ(lights[1].position, glm::vec3(5, 10, 0));
  EXPECT_NEAR(glm::distance(lights[1].direction, glm::vec3(-1, 0, 0)), 0, 1e-6);
  EXPECT_EQ(lights[1].intensity, glm::vec3(1));
  EXPECT_NEAR(glm::distance(lights[2].direction, glm::vec3(-1, 0, 0)), 0, 1e-6);
  EXPECT_EQ(lights[2].range, std::numeric_limits<float>::infinity()) << "the sun has none";
}

TEST_F(GltfLightTest, HiddenAndBlackOnesDoNotShine) {
  add_light({{"type", "point"}});
  add_light({{"type", "point"}, {"intensity", 0}});
  add_node({}, 1);
  EXPECT_TRUE(read().empty());
  gltf.json["extensionsUsed"].push_back("KHR_node_visibility");
  add_node({})["extensions"]["KHR_node_visibility"]["visible"] = false;
  EXPECT_TRUE(read().empty());
  add_node({});
  EXPECT_EQ(read().size(), 1U);
}

TEST_F(GltfLightTest, MoveWithSceneFarFromTheOrigin) {
  add_light({{"type", "point"}});
  gltf.json["nodes"][1]["translation"] = {10000, 0, 0};
  add_node({{"translation", {10000, 0, 3}}});
  const Scene scene = load();
  ASSERT_GT(scene.origin.x, 9999);
  EXPECT_EQ(glm::dvec3(scene.lights.at(0).position) + scene.origin, glm::dvec3(10000, 0, 3));
}

TEST_F(GltfLightTest, RefusesWhatIsOutOfRange) {
  const nlohmann::json spot = {{"name", "lamp"}, {"type", "spot"}, {"spot", nlohmann::json::object()}};
  const std::vector<std::pair<std::string, nlohmann::json>> numbers{
      {"/color", {1, -1, 0}},
      {"/intensity", -1},
      {"/range", 0},
      {"/range", -2},
      {"/spot/outerConeAngle", 0},
      {"/spot/outerConeAngle", 1.6},
      {"/spot/innerConeAngle", -0.25},
      {"/spot/innerConeAngle", 0.8},
  };
  add_light(spot);
  add_node({});
  for (const auto& [path, value] : numbers) {
    light() = spot;
    light()[nlohmann::json::json_pointer(path)] = value;
    expect_error({"light 'lamp': " + path.substr(path.rfind('/') + 1) + " is ", "would be right"});
  }
  light() = {{"name", "lamp"}, {"type", "spot"}};
  expect_error({"light 'lamp' is a spot and has no member spot"});
  light() = {{"name", "lamp"}, {"type", "area"}};
  expect_error({"lights[0].type is \"area\"; one of point spot directional"});
  light() = {{"name", "lamp"}, {"type", "point"}, {"intensity", 1e13}};
  expect_error({"light 'lamp': shines with 1e+13, color times intensity; up to 1e+12 would be right"});
}

TEST_F(GltfLightTest, RefusesNodesWithoutALightOrADirection) {
  add_light({{"type", "directional"}});
  nlohmann::json& node = add_node({{"name", "sun"}, {"scale", {1, 1, 0}}});
  expect_error({"node 'sun': its light is squeezed flat; a scale other than 0 would be right"});
  node["extensions"]["KHR_lights_punctual"]["light"] = 1;
  expect_error(
      {"nodes[2].extensions.KHR_lights_punctual.light is 1; an index below 1, the number of lights"});
  node["extensions"]["KHR_lights_punctual"] = nlohmann::json::object();
  expect_error({"nodes[2].extensions.KHR_lights_punctual.light is missing"});
}

TEST_F(GltfLightTest, WarnsOfWhatIsMeantAllTheSame) {
  add_light(
      {{"name", "lamp"}, {"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}}});
  add_node({});
  expect_warning(
      "light 'lamp': innerConeAngle is outerConeAngle, where KHR_lights_punctual has it less; it is read as "
      "0.4995");
  EXPECT_LT(load().lights.at(0).inner_cone_angle, 0.5F);
  light() = {{"name", "lamp"}, {"type", "point"}, {"color", {2, 0, 1}}, {"intensity", 3}};
  expect_warning(
      "light 'lamp': color is 2 0 1, where KHR_lights_punctual ends at 1; it is read as it stands");
  EXPECT_EQ(load().lights.at(0).intensity, glm::vec3(6, 0, 3));
}

TEST_F(GltfLightTest, ASceneMayHaveNothingElse) {
  add_light({{"type", "point"}});
  add_node({});
  gltf.json["nodes"][1].erase("mesh");
  EXPECT_EQ(load().lights.size(), 1U);
}

}  // namespace
}  // namespace qtrace
