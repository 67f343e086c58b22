// Surfaces that overlap in one plane: a lamp is cut out of its ceiling, a rug out of its floor.
#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "tests/unit/gltf_builder.h"
#include "tests/unit/picture_files.h"

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

const nlohmann::json kWool{{"name", "wool"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
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

TEST_F(GltfOverlapsTest, OfTwoThatDoNotEmitTheOneOnTheOtherIsSeen) {
  for (const bool rug_first : {true, false}) {
    gltf = GltfBuilder();
    gltf.json["materials"] = {{{"name", "plain"}}, kWool};
    if (rug_first) add("wool", kLamp);
    add("plain", kCeiling);
    if (!rug_first) add("wool", kLamp);
    const Scene scene = load();
    EXPECT_NEAR(area_of_material(scene, "plain"), 4 - 0.33, 1e-6);
    EXPECT_EQ(at(scene, 0.03F, 0.01F), (std::pair<int, std::string>{1, "wool"}));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(
        scene.warnings[0].find("in one plane; only the latter is seen there, because it lies more wholly on"),
        std::string::npos)
        << scene.warnings[0];
  }
}

// As the edges of a pot on a book: too little of either to be seen.
TEST_F(GltfOverlapsTest, BodiesThatMerelyTouchStay) {
  gltf.json["materials"][1] = kWool;
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

// A rug with more of its cloth elsewhere.
TEST_F(GltfOverlapsTest, WhatLiesOnTheOtherCountsAndNotWhatIsElsewhere) {
  gltf.json["materials"][1] = kWool;
  add("plain", kCeiling);
  add("wool", kLamp);
  nlohmann::json& primitives = gltf.json["meshes"][1]["primitives"];
  primitives.push_back(gltf.primitive({9, 0, 9, 99, 0, 9, 9, 0, 99}));
  primitives[1]["material"] = 1;
  EXPECT_EQ(at(load(), 0.03F, 0.01F), (std::pair<int, std::string>{1, "wool"}));
}

// Of materials that differ in their names alone, no picture shows which is met.
TEST_F(GltfOverlapsTest, WhatLooksTheSameMayOverlap) {
  gltf.json["materials"][1] = {{"name", "wool"}, {"doubleSided", true}};
  add("plain", kCeiling);
  add("wool", kLamp);
  EXPECT_EQ(load().triangles.size(), 4U);
  EXPECT_TRUE(load().warnings.empty());
}

// Round lamps in a ceiling of two triangles: what lies beside a lamp stays whole.
TEST_F(GltfOverlapsTest, ManyLampsLeaveFewTriangles) {
  add("plain", kCeiling);
  constexpr int kLamps = 9, kSides = 24;
  std::vector<float> corners;
  for (int lamp = 0; lamp < kLamps; ++lamp) {
    const auto x = 0.6F * static_cast<float>(lamp % 3 - 1), z = 0.6F * static_cast<float>(lamp / 3 - 1);
    for (int side = 0; side < kSides; ++side) {
      const auto corner = [&](int i) {
        const double angle = 2 * 3.141592653589793 * i / kSides;
        corners.insert(corners.end(), {x + 0.1F * static_cast<float>(std::cos(angle)), 3,
                                       z + 0.1F * static_cast<float>(std::sin(angle))});
      };
      corners.insert(corners.end(), {x, 3, z});
      corner(side);
      corner(side + 1);
    }
  }
  nlohmann::json lamps = gltf.primitive(corners);
  lamps["material"] = 1;
  gltf.add_node({{"mesh", gltf.add_mesh({lamps})}});
  const Scene scene = load();
  const double disc = kSides / 2.0 * 0.01 * std::sin(2 * 3.141592653589793 / kSides);
  EXPECT_NEAR(area_of_material(scene, "plain"), 4 - kLamps * disc, 1e-5);
  EXPECT_LT(scene.triangles.size(), 2000U);
}

TEST_F(GltfOverlapsTest, PiecesAreCounted) {
  add("plain", kCeiling);
  add("glow", kLamp);
  const std::string bytes = gltf.glb();
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  SceneLimits limits;
  limits.triangles = 5;
  EXPECT_THROW(parse_gltf({data, bytes.size()}, "a.glb", {}, limits), Error);
}

// The front and the back of a leaf: each is seen from its own side, however they are ordered.
TEST_F(GltfOverlapsTest, SidesOfACardAreMovedApart) {
  for (const char* other : {"wool", "glow", "dim"}) {
    for (const bool turned_first : {true, false}) {
      gltf = GltfBuilder();
      gltf.json["materials"] = {{{"name", "glow"}, {"emissiveFactor", {1, 1, 1}}},
                                kWool,
                                {{"name", "dim"}, {"emissiveFactor", {0.5, 0.5, 0.5}}},
                                {{"name", "plain"}}};
      const Rectangle turned{kLamp.x0, -kLamp.z1, kLamp.x1, -kLamp.z0};
      if (turned_first) add(other, turned);
      add("glow", kLamp);
      if (!turned_first) add(other, turned);
      nlohmann::json& node = gltf.json["nodes"][turned_first ? 1 : 2];
      node["rotation"] = {1, 0, 0, 0};  // upside down
      node["translation"] = {0, 6, 0};
      const Scene scene = load();
      ASSERT_EQ(scene.triangles.size(), 4U);
      ASSERT_EQ(scene.warnings.size(), 1U) << ::testing::PrintToString(scene.warnings);
      EXPECT_NE(scene.warnings[0].find("lie back to back in one plane, over an area of "), std::string::npos);
      for (const Triangle& triangle : scene.triangles) {
        for (const glm::vec3& p : triangle.position) {
          EXPECT_EQ(p.y > 3, triangle.normal[0].y > 0) << other << ' ' << turned_first;
          EXPECT_NEAR(p.y, 3, 1e-5);
        }
      }
    }
  }
}

// Lamps in a row touch one another where nobody sees it.
TEST_F(GltfOverlapsTest, LampsThatTouchBackToBackStay) {
  add("glow", kCeiling);
  add("dim", kLamp);
  gltf.json["nodes"][2]["translation"] = {0, 6, 0};
  gltf.json["nodes"][2]["rotation"] = {1, 0, 0, 0};
  EXPECT_EQ(load().triangles.size(), 4U);
  EXPECT_TRUE(load().warnings.empty());
}

// Baked far from the origin, positions are rounded there; moved about the origin, they still are.
TEST_F(GltfOverlapsTest, PlanesAreAsExactAsTheFileHasThem) {
  const glm::dvec3 far(300, 400, 500), across = glm::normalize(glm::dvec3(2, 1, -1)),
                                       along = glm::normalize(glm::dvec3(0.3, 1, 1.6));
  const auto quad = [&](double half, const char* material) {
    std::vector<float> corners;
    for (const auto& [x, y] : {std::pair(-half, -half), {half, -half}, {half, half}, {-half, half}}) {
      const glm::dvec3 p = far + x * across + y * along;
      for (int k = 0; k < 3; ++k) corners.push_back(static_cast<float>(p[k]));
    }
    nlohmann::json primitive = gltf.primitive(corners);
    primitive["indices"] = gltf.add_indices({0, 1, 2, 0, 2, 3});
    primitive["material"] = material == std::string("glow") ? 1 : 0;
    gltf.add_node({{"mesh", gltf.add_mesh({primitive})}});
  };
  quad(1, "plain");
  quad(0.317, "glow");
  gltf.json["nodes"][0]["translation"] = {300, 400, 503};
  const Scene scene = load();
  EXPECT_NE(scene.origin, glm::dvec3(0));
  EXPECT_EQ(scene.warnings.size(), 1U);
  EXPECT_NEAR(area_of_material(scene, "plain"), 4 - 0.634 * 0.634, 1e-3);
}

// From afar, the eye's rays are no more exact than its distance lets them be.
TEST_F(GltfOverlapsTest, PlanesAreAsExactAsTheEyeSeesThem) {
  add("plain", kCeiling);
  add("glow", {kLamp.x0, kLamp.z0, kLamp.x1, kLamp.z1, 2.9999F});
  EXPECT_TRUE(load().warnings.empty());
  gltf.json["nodes"][0]["translation"] = {0, -1000, 0};
  EXPECT_EQ(load().warnings.size(), 1U);
}

// As a box stands on a floor: nobody sees either of them there.
TEST_F(GltfOverlapsTest, SurfacesThatTouchBackToBackStay) {
  gltf.json["materials"][1] = kWool;
  add("plain", kCeiling);
  add("wool", kLamp);
  gltf.json["nodes"][2]["translation"] = {0, 6, 0};
  gltf.json["nodes"][2]["rotation"] = {1, 0, 0, 0};  // upside down
  EXPECT_EQ(load().triangles.size(), 4U);
  EXPECT_TRUE(load().warnings.empty());
}

// Colours and further coordinates go on as they were, as the UV map does.
TEST_F(GltfOverlapsTest, WhatIsCutKeepsItsAttributes) {
  add("plain", kCeiling);
  add("glow", kLamp);
  gltf.json["materials"][0]["normalTexture"] = {{"index", gltf.add_texture(png_of(128, 128, 255))},
                                                {"texCoord", 1}};
  nlohmann::json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_1"] = gltf.add_floats("VEC2", {-3, -1, 3, -1, 3, 1, -3, 1});
  attributes["COLOR_0"] = gltf.add_floats("VEC3", {0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1});
  const Scene scene = load();
  std::size_t pieces = 0;
  for (const Triangle& triangle : scene.triangles) {
    if (triangle.material != 0) continue;
    const TriangleAttributes& found = scene.attributes.at(triangle.attributes);
    ++pieces;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::vec3 p = triangle.position[i];
      EXPECT_NEAR(glm::distance(found.uv1[i], glm::vec2(3 * p.x, p.z)), 0, 1e-5);
      EXPECT_NEAR(glm::distance(found.color[i], glm::vec4((p.x + 1) / 2, (p.z + 1) / 2, 1, 1)), 0, 1e-5);
      EXPECT_NEAR(glm::distance(found.tangent[i], glm::vec4(1, 0, 0, -1)), 0, 1e-5) << "from below it is seen in a mirror";
    }
  }
  EXPECT_GT(pieces, 4U);
}

// Cut out under a transparent decal, the wall would have a hole.
TEST_F(GltfOverlapsTest, WhatLetsLightPassIsLiftedOff) {
  gltf.json["materials"][2] = {{"name", "decal"}, {"alphaMode", "MASK"}};
  add("plain", kCeiling);
  add("decal", kLamp);
  const Scene scene = load();
  EXPECT_NEAR(area_of_material(scene, "plain"), 4, 1e-6);
  for (const Triangle& triangle : scene.triangles) {
    for (const glm::vec3& p : triangle.position) {
      if (triangle.material == 2) {
        EXPECT_LT(p.y, 3) << "it faces down";
        EXPECT_GT(p.y, 2.999F);
      } else {
        EXPECT_EQ(p.y, 3);
      }
    }
  }
  EXPECT_EQ(scene.warnings,
            std::vector<std::string>{
                "object 'plain 0' (plain) and object 'decal 1' (decal) share an area of 0.33 in one "
                "plane; the latter lets light pass, and is lifted off the other"});
  gltf.json["materials"][2] = {{"name", "decal"}};
  gltf.json["materials"][2]["pbrMetallicRoughness"]["metallicFactor"] = 0;
  EXPECT_NEAR(area_of_material(load(), "plain"), 4 - 0.33, 1e-6) << "an opaque one covers it";
}

// Two objects of one material look different where their textures do.
TEST_F(GltfOverlapsTest, TexturesOfOneMaterialShow) {
  add("plain", kCeiling);
  add("plain", kLamp);
  EXPECT_TRUE(load().warnings.empty());
  gltf.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] =
      gltf.add_texture(png_of(1, 2, 3));
  const Scene scene = load();
  EXPECT_EQ(scene.warnings.size(), 1U);
  EXPECT_NEAR(area_of_material(scene, "plain"), 4, 1e-6);
}

}  // namespace
}  // namespace qtrace
