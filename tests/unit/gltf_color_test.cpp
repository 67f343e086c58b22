// Colours of vertices.
#include "tests/unit/gltf_builder.h"

namespace qtrace {
namespace {

class GltfColorTest : public GltfTest {
 protected:
  GltfColorTest() { gltf.add_triangle(); }
  void set_colors(std::size_t accessor, bool is_normalized = false) {
    if (is_normalized) gltf.json["accessors"][accessor]["normalized"] = true;
    gltf.primitive_json()["attributes"]["COLOR_0"] = accessor;
  }
  std::array<glm::vec4, 3> read() {
    const Scene scene = load();
    EXPECT_TRUE(scene.warnings.empty()) << ::testing::PrintToString(scene.warnings);
    return scene.attributes.at(scene.triangles.at(0).attributes).color;
  }
};

TEST_F(GltfColorTest, MayBeFloatsBytesOrShortsWithOrWithoutOpacity) {
  const std::array opaque{glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1), glm::vec4(0.2F, 0.4F, 0.6F, 1)};
  set_colors(gltf.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0.2F, 0.4F, 0.6F}));
  EXPECT_EQ(read(), opaque);
  set_colors(gltf.add_accessor(std::vector<std::uint16_t>{65535, 0, 0, 0, 65535, 0, 13107, 26214, 39321},
                               "VEC3", kUnsignedShort),
             true);
  EXPECT_EQ(read(), opaque);
  const std::vector<std::uint8_t> bytes{255, 0, 0, 51, 0, 255, 0, 255, 51, 102, 153, 0};
  const std::array clear{glm::vec4(1, 0, 0, 0.2F), glm::vec4(0, 1, 0, 1), glm::vec4(0.2F, 0.4F, 0.6F, 0)};
  set_colors(gltf.add_accessor(bytes, "VEC4", kUnsignedByte), true);
  EXPECT_EQ(read(), clear);
  set_colors(gltf.add_floats("VEC4", {1, 0, 0, 0.2F, 0, 1, 0, 1, 0.2F, 0.4F, 0.6F, 0}));
  EXPECT_EQ(read(), clear);
}

TEST_F(GltfColorTest, RefusesOtherTypes) {
  set_colors(gltf.add_floats("VEC2", {1, 0, 0, 0, 1, 0}));
  expect_error({"mesh 'shape' primitive 0 COLOR_0 (accessor 1) has the wrong type",
                "VEC3 or VEC4 of float, or of normalized unsigned bytes or shorts would be right"});
  set_colors(gltf.add_accessor(std::vector<std::uint8_t>(12), "VEC4", kUnsignedByte));
  expect_error({"COLOR_0 (accessor 2) has the wrong type"});
  set_colors(gltf.add_floats("VEC3", {1, 0, 0}));
  expect_error({"COLOR_0 (accessor 3) has a count of 1; 3, as POSITION has, would be right"});
}

TEST_F(GltfColorTest, WhiteIsNoColour) {
  set_colors(gltf.add_floats("VEC3", std::vector<float>(9, 1)));
  const Scene scene = load();
  EXPECT_TRUE(scene.attributes.empty());
  EXPECT_EQ(scene.triangles.at(0).attributes, kNoAttributes);
}

TEST_F(GltfColorTest, FollowTheirCornersThroughMirrors) {
  set_colors(gltf.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1}));
  gltf.json["nodes"][1]["scale"] = {-1, 1, 1};
  const Scene scene = load();
  const Triangle& triangle = scene.triangles.at(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec4 color = scene.attributes.at(triangle.attributes).color[i];
    const glm::vec3 p = triangle.position[i];
    EXPECT_EQ(color, glm::vec4(1 + p.x - p.y, -p.x, p.y, 1)) << i;
  }
}

TEST_F(GltfColorTest, IsClampedWithAWarning) {
  set_colors(gltf.add_floats("VEC3", {1.0001F, 0, 0, 2, 0.5F, 0, 0.5F, -1, 0.5F}));
  expect_warning("object 'thing': the COLOR_0 of 2 of 3 corners is outside of 0 to 1; it is clamped");
  EXPECT_EQ(load().attributes.at(0).color,
            (std::array{glm::vec4(1, 0, 0, 1), glm::vec4(1, 0.5F, 0, 1), glm::vec4(0.5F, 0, 0.5F, 1)}));
}

}  // namespace
}  // namespace qtrace
