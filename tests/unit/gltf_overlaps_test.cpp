// Surfaces that overlap in one plane: a lamp is cut out of its ceiling, a rug out of its floor.
#include "tests/unit/gltf_builder.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace qtrace {
namespace {

// A rectangle at height `y` that faces down, from (x0, z0) to (x1, z1), with a UV map that is its x and z.
struct Rectangle {
  float x0, z0, x1, z1;
  float y = 3;
};

class GltfOverlapsTest : public GltfTest {
 protected:
  // Nodes named after their materials.
  void add(const std::string& material, const Rectangle& r) {
    nlohmann::json primitive =
        gltf.primitive({r.x0, r.y, r.z0, r.x1, r.y, r.z0, r.x1, r.y, r.z1, r.x0, r.y, r.z1});
    primitive["attributes"]["TEXCOORD_0"] =
        gltf.add_floats("VEC2", {r.x0, r.z0, r.x1, r.z0, r.x1, r.z1, r.x0, r.z1});
    primitive["indices"] = gltf.add_indices({0, 1, 2, 0, 2, 3});
    for (std::size_t i = 0; i < gltf.json["materials"].size(); ++i) {
      if (gltf.json["materials"][i]["name"] == material) primitive["material"] = i;
    }
    const std::size_t mesh = gltf.add_mesh({primitive});
    gltf.add_node({{"name", fmt::format("{} {}", material, mesh)}, {"mesh", mesh}});
  }
  GltfOverlapsTest() {
    gltf.json["materials"] = {{{"name", "plain"}},
                              {{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}},
                              {{"name", "dim"}, {"emissiveFactor", {0.5, 0.5, 0.5}}}};
  }

  static double area_of_material(const Scene& scene, const std::string& name) {
    double sum = 0;
    for (const Triangle& triangle : scene.triangles) {
      if (scene.materials[triangle.material].name == name) sum += area_of(triangle);
    }
    return sum;
  }
  // How many triangles a line along y at (x, z) meets, and the material of the last one.
  static std::pair<int, std::string> at(const Scene& scene, float x, float z) {
    std::pair<int, std::string> result{0, ""};
    for (const Triangle& triangle : scene.triangles) {
      int sides = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec3 a = triangle.position[i], b = triangle.position[(i + 1) % 3];
        sides += (b.x - a.x) * (z - a.z) - (b.z - a.z) * (x - a.x) > 0 ? 1 : -1;
      }
      if (std::abs(sides) != 3) continue;
      ++result.first;
      result.second = scene.materials[triangle.material].name;
    }
    return result;
  }
  // At many places one surface, which is the lamp within `lamp`.
  static void expect_one_surface(const Scene& scene, const Rectangle& all, const Rectangle& lamp) {
    for (int i = 0; i < 400; ++i) {
      const float x = all.x0 + (all.x1 - all.x0) * std::fmod(0.618034F * static_cast<float>(i) + 0.1F, 1.0F);
      const float z = all.z0 + (all.z1 - all.z0) * std::fmod(0.754878F * static_cast<float>(i) + 0.2F, 1.0F);
      const bool in_lamp = x > lamp.x0 && x < lamp.x1 && z > lamp.z0 && z < lamp.z1;
      EXPECT_EQ(at(scene, x, z), (std::pair<int, std::string>{1, in_lamp ? "glow" : "plain"}))
          << x << ' ' << z;
    }
  }
};

const Rectangle kCeiling{-1, -1, 1, 1}, kLamp{-0.3F, -0.2F, 0.25F, 0.4F};

TEST_F(GltfOverlapsTest, ALampIsCutOutOfItsCeilingWhateverTheirOrder) {
  for (const bool lamp_first : {true, false}) {
    gltf = GltfBuilder();
    gltf.json["materials"] = {{{"name", "plain"}}, {{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}}};
    if (lamp_first) add("glow", kLamp);
    add("plain", kCeiling);
    if (!lamp_first) add("glow", kLamp);
    const Scene scene = load();
    expect_one_surface(scene, kCeiling, kLamp);
    EXPECT_NEAR(area_of_material(scene, "glow"), 0.33, 1e-6);
    EXPECT_NEAR(area_of_material(scene, "plain"), 4 - 0.33, 1e-6);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find(
                  "share an area of 0.33 in one plane; only the latter is seen there, because it emits"),
              std::string::npos)
        << scene.warnings[0];
    for (const Triangle& triangle : scene.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(triangle.uv[i].x, triangle.position[i].x, 1e-6) << "the UV map goes on as it was";
        EXPECT_NEAR(triangle.uv[i].y, triangle.position[i].z, 1e-6);
        EXPECT_EQ(triangle.position[i].y, 3);
        EXPECT_EQ(triangle.normal[i].y, scene.triangles[0].normal[0].y);
      }
    }
    for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
      for (std::uint32_t i = 0; i < scene.objects[object].triangle_count; ++i) {
        EXPECT_EQ(scene.triangles.at(scene.objects[object].first_triangle + i).object, object);
      }
    }
  }
}

TEST_F(GltfOverlapsTest, ALampMayReachBeyondAndBeTilted) {
  add("plain", kCeiling);
  add("glow", {0.5F, -0.4F, 1.5F, 0.6F});
  EXPECT_NEAR(area_of_material(load(), "plain"), 4 - 0.5, 1e-6);
  EXPECT_NEAR(area_of_material(load(), "glow"), 1, 1e-6);
  // Turned about an axis that no coordinate has, the planes agree but for rounding.
  for (std::size_t i = 1; i <= 2; ++i) gltf.json["nodes"][i]["rotation"] = {0.2, 0.4, 0.4, 0.8};
  for (std::size_t i = 1; i <= 2; ++i) gltf.json["nodes"][i]["translation"] = {7, -3, 11};
  EXPECT_NEAR(area_of_material(load(), "plain"), 4 - 0.5, 1e-5);
}

TEST_F(GltfOverlapsTest, ACoveredSurfaceIsLeftOut) {
  add("plain", kLamp);
  add("glow", kCeiling);
  const Scene scene = load();
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(scene.triangles[0].object, 0U);
}

TEST_F(GltfOverlapsTest, AMillimetreApartTheyStay) {
  add("plain", kCeiling);
  add("glow", {kLamp.x0, kLamp.z0, kLamp.x1, kLamp.z1, 2.999F});
  EXPECT_TRUE(load().warnings.empty());
  EXPECT_EQ(load().triangles.size(), 4U);
}

TEST_F(GltfOverlapsTest, NeighboursOfALampStay) {
  add("plain", {-1, -1, 0.5F, 1});
  add("glow", {0.5F, -1, 1, 1});
  add("plain", {-1, 1, 1, 2});
  EXPECT_TRUE(load().warnings.empty());
  EXPECT_EQ(load().triangles.size(), 6U);
}

TEST_F(GltfOverlapsTest, LampsThatOverlapCountOnceOrAreRefused) {
  add("glow", kCeiling);
  add("glow", {0.5F, 0, 1.5F, 1});
  const Scene scene = load();
  EXPECT_NEAR(area_of_material(scene, "glow"), 4 + 0.5, 1e-6);
  EXPECT_EQ(at(scene, 0.75F, 0.52F).first, 1);
  EXPECT_EQ(scene.warnings.size(), 1U);
  add("dim", {-0.5F, -0.5F, 0, 0});
  expect_error({"object 'glow 0' and object 'dim 2' lie in one plane and overlap, and do not emit alike"});
}

TEST_F(GltfOverlapsTest, OfOneMaterialSurfacesMayOverlap) {
  add("plain", kCeiling);
  add("plain", kLamp);
  EXPECT_EQ(load().triangles.size(), 4U);
  EXPECT_TRUE(load().warnings.empty());
}

TEST_F(GltfOverlapsTest, OfTwoThatDoNotEmitTheSmallerIsSeen) {
  for (const bool rug_first : {true, false}) {
    gltf = GltfBuilder();
    gltf.json["materials"] = {{{"name", "plain"}}, {{"name", "wool"}}};
    if (rug_first) add("wool", kLamp);
    add("plain", kCeiling);
    if (!rug_first) add("wool", kLamp);
    const Scene scene = load();
    EXPECT_NEAR(area_of_material(scene, "plain"), 4 - 0.33, 1e-6);
    EXPECT_EQ(at(scene, 0.03F, 0.01F), (std::pair<int, std::string>{1, "wool"}));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find("in one plane; only the latter is seen there, because it is smaller"),
              std::string::npos)
        << scene.warnings[0];
  }
}

// As the edges of a pot on a book: too little of either to be seen.
TEST_F(GltfOverlapsTest, BodiesThatMerelyTouchStay) {
  gltf.json["materials"][1] = {{"name", "wool"}};
  add("plain", kCeiling);
  add("wool", {0.999F, -1, 2, 1});
  EXPECT_EQ(load().triangles.size(), 4U);
  EXPECT_TRUE(load().warnings.empty());
  add("wool", {-2, -1, -0.98F, 1});  // a fiftieth of it
  EXPECT_EQ(load().warnings.size(), 1U);
  EXPECT_EQ(at(load(), -0.99F, 0.5F).first, 1);
}

// Of a lamp nothing is too little: a hair's breadth of it would still be lost half.
TEST_F(GltfOverlapsTest, ALampWinsHoweverSmallTheOverlap) {
  add("plain", kCeiling);
  add("glow", {0.999F, -1, 2, 1});
  EXPECT_EQ(load().warnings.size(), 1U);
  EXPECT_EQ(at(load(), 0.9995F, 0.5F), (std::pair<int, std::string>{1, "glow"}));
}

// As a box stands on a floor: nobody sees either of them there.
TEST_F(GltfOverlapsTest, SurfacesThatTouchBackToBackStay) {
  gltf.json["materials"][1] = {{"name", "wool"}};
  add("plain", kCeiling);
  add("wool", kLamp);
  gltf.json["nodes"][2]["translation"] = {0, 6, 0};
  gltf.json["nodes"][2]["rotation"] = {1, 0, 0, 0};  // upside down
  EXPECT_EQ(load().triangles.size(), 4U);
  EXPECT_TRUE(load().warnings.empty());
}

}  // namespace
}  // namespace qtrace
