// Which camera a picture is taken through, and what of a file's camera it does not have.
#include "engine/scene/cameras.h"
#include "tests/unit/gltf_builder.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace {
namespace {

View through(const NameOrIndex& camera) {
  View view;
  view.camera.of_file = camera;
  return view;
}
View from(const CameraPlace& place) {
  View view;
  view.camera.kind = CameraChoice::Kind::placed;
  view.camera.place = place;
  return view;
}
View with_aspect(double aspect) {
  View view;
  view.aspect = aspect;
  return view;
}
View fit(double aspect) {
  View view = with_aspect(aspect);
  view.camera.kind = CameraChoice::Kind::fit;
  return view;
}
View of_scene(const NameOrIndex& scene) {
  View view;
  view.scene = scene;
  return view;
}

class GltfCameraTest : public GltfTest {
 protected:
  GltfCameraTest() { gltf.add_triangle(); }

  // The warnings of a lone perspective camera at the origin, 10 in front of a wall of 4 by 4 that faces it.
  std::vector<std::string> warnings_of(nlohmann::json lens, double aspect) {
    lens["yfov"] = glm::half_pi<double>();
    gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", lens}}};
    gltf.json["nodes"][0]["translation"] = {0, 0, 10};
    gltf.json["nodes"][1]["scale"] = {4, 4, 1};
    return load(with_aspect(aspect)).warnings;
  }

  void expect_position(const Scene& scene, glm::vec3 position) const {
    EXPECT_EQ(glm::vec3(scene.camera.world_from_camera[3]), position);
  }
};

TEST_F(GltfCameraTest, OfTheFileByNameOrIndex) {
  gltf.json["cameras"].push_back(
      {{"name", "wide"}, {"type", "perspective"}, {"perspective", {{"yfov", 1.5}, {"znear", 0.1}}}});
  gltf.add_node({{"name", "other"}, {"camera", 1}, {"translation", {9, 9, 9}}});
  for (const NameOrIndex& choice : {NameOrIndex{"other", {}}, NameOrIndex{"wide", {}}, NameOrIndex{"", 1}}) {
    const Scene scene = load(through(choice));
    expect_position(scene, {9, 9, 9});
    EXPECT_EQ(scene.camera.vertical_fov, 1.5F);
    EXPECT_TRUE(scene.warnings.empty()) << "no camera is ignored where one is named";
  }
  expect_position(load(through({"eye", {}})), {0, 0, 0});
  expect_error(through({"moon", {}}),
               {"key 'camera' is 'moon', which no camera of the scene is called; there are camera 0 at "
                "node 'eye', camera 'wide' at node 'other'"});
  expect_error(through({"", 2}), {"key 'camera' is 2, which no camera"});
  gltf.add_node({{"name", "third"}, {"camera", 1}});
  expect_error(through({"wide", {}}),
               {"key 'camera' is 'wide', which may be camera 'wide' at node 'other', camera 'wide' at "
                "node 'third'; the name of a node would be right"});
}

TEST_F(GltfCameraTest, NodesWithoutANameGoByTheirIndex) {
  gltf.json["nodes"][0].erase("name");
  gltf.add_node({{"camera", 0}, {"translation", {9, 9, 9}}});
  expect_error(through({"", 0}),
               {"camera 0 at node 0, camera 0 at node 2; the name of a node would be right"});
  expect_position(load(through({"node 2", {}})), {9, 9, 9});
}

TEST_F(GltfCameraTest, PlacedInTheFilesWorld) {
  gltf.json["nodes"][0].erase("camera");
  const Camera camera = load(from({{1, 2, 3}, {1, 2, -3}, {0, 3, 1}, 60})).camera;
  EXPECT_EQ(camera.world_from_camera, glm::translate(glm::mat4(1), glm::vec3(1, 2, 3)));
  EXPECT_FLOAT_EQ(camera.vertical_fov, glm::pi<float>() / 3);
  // Far from the origin positions count from there, and so does the camera's.
  gltf.json["nodes"][1]["translation"] = {1e7, 0, 0};
  const Scene far = load(from({{1e7 + 0.5, 0, 4}, {1e7 + 0.5, 0, 0}, {0, 1, 0}, 60}));
  EXPECT_GT(far.origin.x, 9e6);
  EXPECT_EQ(static_cast<double>(far.camera.world_from_camera[3].x) + far.origin.x, 1e7 + 0.5);
  expect_error(from({{1, 2, 3}, {1, 2, 3}, {0, 1, 0}, 60}),
               {"key 'camera': the camera's position and target are both 1 2 3"});
  expect_error(from({{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 60}),
               {"key 'camera': the camera's up 0 1 0 lies along its viewing direction"});
  expect_error(from({{0, 5, 1}, {0, 0, 0}, {0, 0, 0}, 60}), {"the camera's up 0 0 0"});
}

// Every corner is inside the picture, and one of them near its border.
TEST_F(GltfCameraTest, FitShowsEverything) {
  gltf.json["nodes"][0].erase("camera");
  gltf.add_node({{"mesh", 0}, {"translation", {3, 1, -5}}, {"scale", {2, 9, 1}}});
  gltf.add_node(
      {{"mesh", 0}, {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}, {"translation", {-4, 0, 2}}});
  for (const double aspect : {0.4, 1.0, 2.5}) {
    const Scene scene = load(fit(aspect));
    const glm::dmat4 camera_from_world = glm::inverse(glm::dmat4(scene.camera.world_from_camera));
    const double half = std::tan(static_cast<double>(scene.camera.vertical_fov) / 2);
    double farthest = 0;
    for (const Triangle& triangle : scene.triangles) {
      for (const glm::vec3& position : triangle.position) {
        const glm::dvec4 p = camera_from_world * glm::dvec4(glm::dvec3(position), 1);
        ASSERT_LT(p.z, 0);
        farthest =
            std::max({farthest, std::abs(p.x) / (-p.z * half * aspect), std::abs(p.y) / (-p.z * half)});
      }
    }
    EXPECT_LT(farthest, 1) << aspect;
    EXPECT_GT(farthest, 0.9) << aspect;
    EXPECT_GT(scene.camera.world_from_camera[2].z, 0.9F) << "from the front";
    EXPECT_GT(scene.camera.world_from_camera[2].y, 0.1F) << "and above";
  }
}

TEST_F(GltfCameraTest, WithoutOneTheMessageShowsOneThatWouldDo) {
  gltf.json["nodes"][0].erase("camera");
  expect_error(
      {"the scene has no camera; key 'camera' says where one stands: \"fit\" shows everything, as "
       "{\"position\": [0.5, ",
       "\"target\": [0.5, 0.5, 0], \"fov\": 40} does here"});
}

TEST_F(GltfCameraTest, OrthographicHasAFilmInPlaceOfAnAngle) {
  gltf.json["cameras"][0] = {{"type", "orthographic"},
                             {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}};
  const Scene scene = load(with_aspect(1.5));
  EXPECT_EQ(scene.camera.film_height, 4);
  EXPECT_TRUE(scene.warnings.empty());
  for (const char* size : {"xmag", "ymag"}) {
    for (const double value : {0.0, -1.0}) {
      gltf.json["cameras"][0]["orthographic"] = {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}};
      gltf.json["cameras"][0]["orthographic"][size] = value;
      expect_error({"camera 0 at node 'eye': xmag and ymag are ", "both above 0 would be right"});
    }
  }
}

TEST_F(GltfCameraTest, WarnsOfAnotherAspectRatio) {
  EXPECT_TRUE(warnings_of({{"znear", 0.1}, {"aspectRatio", 2}}, 2).empty());
  EXPECT_TRUE(warnings_of({{"znear", 0.1}}, 2).empty());
  const std::vector<std::string> warnings = warnings_of({{"znear", 0.1}, {"aspectRatio", 2}}, 1);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0],
            "camera 0 at node 'eye': its aspectRatio is 2 and the picture's is 1; the height of what is seen "
            "stays, the width does not");
}

TEST_F(GltfCameraTest, WarnsOfDepthsThatItsFileWouldCutOff) {
  EXPECT_TRUE(warnings_of({{"znear", 9.9}, {"zfar", 10.1}}, 1).empty());
  EXPECT_NE(warnings_of({{"znear", 10.1}, {"zfar", 99}}, 1).at(0).find("nearer than its znear of 10.1"),
            std::string::npos);
  EXPECT_NE(warnings_of({{"znear", 0.1}, {"zfar", 9.9}}, 1).at(0).find("farther than its zfar of 9.9"),
            std::string::npos);
  // Behind the camera, and beside the picture, nothing is seen.
  gltf.json["nodes"][1]["translation"] = {0, 0, 30};
  EXPECT_TRUE(warnings_of({{"znear", 50}}, 1).empty());
  gltf.json["nodes"][1]["translation"] = {30, 0, 0};
  EXPECT_TRUE(warnings_of({{"znear", 50}}, 1).empty());
  EXPECT_EQ(warnings_of({{"znear", 50}}, 4).size(), 1U) << "a wider picture has it";
}

TEST_F(GltfCameraTest, OneOfSeveralScenesIsChosen) {
  gltf.add_node({{"name", "far"}, {"mesh", 0}, {"translation", {0, 0, -8}}});
  gltf.json["scenes"] = {{{"name", "near"}, {"nodes", {0, 1}}}, {{"name", "distant"}, {"nodes", {0, 2}}}};
  const auto depth = [&](const NameOrIndex& scene) {
    return load(of_scene(scene)).triangles.at(0).position[0].z;
  };
  EXPECT_EQ(depth({}), 0);
  EXPECT_EQ(depth({"distant", {}}), -8);
  EXPECT_EQ(depth({"", 1}), -8);
  expect_error(of_scene({"middle", {}}),
               {"key 'gltf_scene' is 'middle', but there is none of this name or index; the file has "
                "scene 'near', scene 'distant'"});
  expect_error(of_scene({"", 2}), {"key 'gltf_scene' is 2, but there is none"});
  gltf.json["scenes"][1]["name"] = "near";
  expect_error(of_scene({"near", {}}), {"but there are several of this name"});
  gltf.json.erase("scene");
  expect_warning(
      "the file has 2 scenes and says of none that it is the default; the first is read (key 'gltf_scene' "
      "chooses)");
  gltf.json.erase("scenes");
  gltf.json["nodes"].erase(2);
  expect_error(of_scene({"", 0}), {"key 'gltf_scene' is 0, but the file names no scenes"});
}

}  // namespace
}  // namespace qtrace
