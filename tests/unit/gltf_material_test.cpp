// Materials.
#include "tests/unit/gltf_builder.h"

namespace qtrace {
namespace {

class GltfMaterialTest : public GltfTest {
 protected:
  GltfMaterialTest() {
    gltf.add_triangle();
    gltf.json["materials"] = {{{"name", "wood"}}};
    gltf.primitive_json()["material"] = 0;
  }
  nlohmann::json& material() { return gltf.json["materials"][0]; }
  nlohmann::json& pbr() { return material()["pbrMetallicRoughness"]; }
  nlohmann::json& specular() { return material()["extensions"]["KHR_materials_specular"]; }
  nlohmann::json& strength() {
    return material()["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"];
  }
};

TEST_F(GltfMaterialTest, ReadsEveryFactor) {
  pbr() = {{"baseColorFactor", {0.25, 0.5, 0.75, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}};
  specular() = {{"specularFactor", 0}, {"specularColorFactor", {1, 2, 3}}};
  strength() = 8;
  material()["emissiveFactor"] = {1, 0.5, 0};
  material()["doubleSided"] = true;
  gltf.json["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_emissive_strength"};
  gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"];
  const Scene scene = load();
  ASSERT_EQ(scene.materials.size(), 1U);
  Material expected;
  expected.name = "wood";
  expected.base_color = {0.25F, 0.5F, 0.75F};
  expected.metallic = 0;
  expected.roughness = 0.5F;
  expected.specular = 0;
  expected.specular_color = {1, 2, 3};
  expected.emission = {8, 4, 0};
  expected.double_sided = true;
  EXPECT_EQ(scene.materials[0], expected);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfMaterialTest, TakesTheDefaultsOfTheFormat) {
  material().erase("name");
  gltf.json["meshes"][0]["primitives"].push_back(gltf.primitive({0, 0, 1, 1, 0, 1, 0, 1, 1}));
  const Scene scene = load();
  ASSERT_EQ(scene.materials.size(), 2U);
  Material expected;
  expected.name = "material 0";
  EXPECT_EQ(scene.materials[0], expected);
  expected.name = "default";
  EXPECT_EQ(scene.materials[1], expected);
  EXPECT_EQ(scene.triangles.at(0).material, 0U);
  EXPECT_EQ(scene.triangles.at(1).material, 1U);
}

TEST_F(GltfMaterialTest, ReadsStrengthsThatNoIntHolds) {
  strength() = 3000000000;
  material()["emissiveFactor"] = {1, 0, 0};
  EXPECT_EQ(load().materials.at(0).emission, glm::vec3(3e9F, 0, 0));
}

TEST_F(GltfMaterialTest, RoundedFactorsAreWithinTheirRange) {
  material()["pbrMetallicRoughness"]["roughnessFactor"] = 1.000001;
  expect_warning("material 'wood': roughnessFactor is 1.000001; it is read as 1");
  EXPECT_EQ(load().materials.at(0).roughness, 1);
  material()["pbrMetallicRoughness"]["roughnessFactor"] = -1e-7;
  EXPECT_EQ(load().materials.at(0).roughness, 0);
}

TEST_F(GltfMaterialTest, RefusesFactorsOutOfRange) {
  const std::vector<std::pair<std::string, nlohmann::json>> factors{
      {"/pbrMetallicRoughness/baseColorFactor", {0, 1.5, 0, 1}},
      {"/pbrMetallicRoughness/baseColorFactor", {0, 0, -0.5, 1}},
      {"/pbrMetallicRoughness/baseColorFactor", {0, 0, 0, 2}},
      {"/pbrMetallicRoughness/metallicFactor", -0.1},
      {"/pbrMetallicRoughness/metallicFactor", 1.1},
      {"/pbrMetallicRoughness/roughnessFactor", 2},
      {"/emissiveFactor", {0, -1.25, 0}},
      {"/extensions/KHR_materials_emissive_strength/emissiveStrength", -1},
      {"/extensions/KHR_materials_specular/specularFactor", 1.5},
      {"/extensions/KHR_materials_specular/specularColorFactor", {0, -2, 0}},
  };
  const nlohmann::json good = material();
  for (const auto& [path, value] : factors) {
    material() = good;
    material()[nlohmann::json::json_pointer(path)] = value;
    expect_error({"material 'wood': " + path.substr(path.rfind('/') + 1) + " is ", "would be right"});
  }
  material() = good;
  pbr()["roughnessFactor"] = nullptr;  // what JSON libraries make of NaN
  expect_error({"materials[0].pbrMetallicRoughness.roughnessFactor is null; a finite number"});
  pbr() = {{"baseColorFactor", {1, 1, 1}}};
  expect_error({"materials[0].pbrMetallicRoughness.baseColorFactor is an array; an array of 4 numbers"});
}

TEST_F(GltfMaterialTest, ReadsEmissiveFactorsAboveOneWithAWarning) {
  material()["emissiveFactor"] = {4, 12, 100};
  expect_warning(
      "material 'wood': emissiveFactor is 4 12 100, where glTF ends at 1; it is read as it stands");
  EXPECT_EQ(load().materials.at(0).emission, glm::vec3(4, 12, 100));
}

TEST_F(GltfMaterialTest, RefusesLampsWhoseSquaresNoFloatHolds) {
  gltf.json["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  material()["emissiveFactor"] = {1, 0.5, 0};
  strength() = 1e12;
  EXPECT_EQ(load().materials.at(0).emission.r, 1e12F);
  for (const double value : {1.1e12, 1e30, 3e38}) {
    strength() = value;
    expect_error({fmt::format(
        "material 'wood': emits {:g}, emissiveFactor times emissiveStrength; up to 1e+12", value)});
  }
  strength() = 3e38;
  material()["emissiveFactor"] = {100, 0, 0};  // infinite as a float
  expect_error({"material 'wood': emits 3e+40, "});
}

TEST_F(GltfMaterialTest, OpacityCountsWhereTheAlphaModeSaysSo) {
  pbr()["baseColorFactor"] = {1, 1, 1, 0.25};
  material()["alphaCutoff"] = 0.75;
  EXPECT_EQ(load().materials.at(0).alpha_mode, AlphaMode::opaque);
  EXPECT_EQ(load().materials.at(0).opacity, 1) << "of no consequence";
  material()["alphaMode"] = "BLEND";
  EXPECT_EQ(load().materials.at(0).alpha_mode, AlphaMode::blend);
  EXPECT_EQ(load().materials.at(0).opacity, 0.25F);
  EXPECT_EQ(load().materials.at(0).alpha_cutoff, 0.5F) << "of no consequence";
  material()["alphaMode"] = "MASK";
  EXPECT_EQ(load().materials.at(0).alpha_mode, AlphaMode::mask);
  EXPECT_EQ(load().materials.at(0).alpha_cutoff, 0.75F);
  EXPECT_TRUE(load().warnings.empty());
  material()["alphaMode"] = "GLASS";
  expect_error({"materials[0].alphaMode is \"GLASS\"; one of OPAQUE MASK BLEND"});
}

// Factors of extensions and what they are where the file does not have them.
class GltfMaterialExtensionTest : public GltfMaterialTest {
 protected:
  nlohmann::json& extension(const std::string& name) {
    gltf.json["extensionsUsed"] = {"KHR_materials_clearcoat",    "KHR_materials_ior",
                                   "KHR_materials_transmission", "KHR_materials_unlit",
                                   "KHR_materials_volume",       "KHR_materials_specular"};
    gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"];
    return material()["extensions"]["KHR_materials_" + name];
  }
  Material read() {
    const Scene scene = load();
    EXPECT_TRUE(scene.warnings.empty()) << ::testing::PrintToString(scene.warnings);
    return scene.materials.at(0);
  }
};

TEST_F(GltfMaterialExtensionTest, EmptyOnesChangeNothing) {
  const Material plain = read();
  for (const char* name : {"clearcoat", "ior", "transmission", "volume", "specular"}) {
    extension(name) = nlohmann::json::object();
    EXPECT_EQ(read(), plain) << name;
  }
}

TEST_F(GltfMaterialExtensionTest, ReadsGlass) {
  extension("transmission") = {{"transmissionFactor", 0.75}};
  EXPECT_EQ(read().transmission, 0.75F);
  EXPECT_TRUE(read().is_thin);
  extension("volume") = {{"thicknessFactor", 0},
                         {"attenuationDistance", 2},
                         {"attenuationColor", {0.25, 0.5, 1}},
                         {"thicknessTexture", {{"index", 0}}}};
  gltf.json["textures"] = {nlohmann::json::object()};
  EXPECT_TRUE(read().is_thin);
  EXPECT_EQ(read().attenuation_color, glm::vec3(1));
  extension("volume")["thicknessFactor"] = 0.01;
  EXPECT_FALSE(read().is_thin);
  EXPECT_EQ(read().attenuation_distance, 2);
  EXPECT_EQ(read().attenuation_color, glm::vec3(0.25F, 0.5F, 1));
  extension("transmission")["transmissionFactor"] = 0;
  Material expected;
  expected.name = "wood";
  EXPECT_EQ(read(), expected) << "no light comes into the volume";
}

TEST_F(GltfMaterialExtensionTest, ReadsIndicesOfRefraction) {
  for (const double ior : {0.0, 1.0, 1.33, 2.5}) {
    extension("ior")["ior"] = ior;
    EXPECT_EQ(read().ior, static_cast<float>(ior));
  }
  for (const double ior : {0.5, -1.5, 0.999}) {
    extension("ior")["ior"] = ior;
    expect_error({fmt::format("material 'wood': ior is {}; 1 or more, or 0, would be right", ior)});
  }
}

TEST_F(GltfMaterialExtensionTest, ReadsCoats) {
  extension("clearcoat") = {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.25}};
  EXPECT_EQ(read().clearcoat, 0.5F);
  EXPECT_EQ(read().clearcoat_roughness, 0.25F);
}

TEST_F(GltfMaterialExtensionTest, OfAnUnlitOneTheColourCounts) {
  extension("unlit") = nlohmann::json::object();
  extension("transmission")["transmissionFactor"] = 1;
  pbr() = {{"baseColorFactor", {0.5, 0.25, 1, 0.5}}, {"roughnessFactor", 0.5}};
  material()["emissiveFactor"] = {1, 1, 1};
  material()["alphaMode"] = "BLEND";
  Material expected;
  expected.name = "wood";
  expected.base_color = {0.5F, 0.25F, 1};
  expected.opacity = 0.5F;
  expected.alpha_mode = AlphaMode::blend;
  expected.is_unlit = true;
  EXPECT_EQ(read(), expected);
}

TEST_F(GltfMaterialExtensionTest, RefusesFactorsOutOfRange) {
  const std::vector<std::pair<std::string, nlohmann::json>> factors{
      {"/alphaCutoff", -0.5},
      {"/extensions/KHR_materials_transmission/transmissionFactor", 1.5},
      {"/extensions/KHR_materials_volume/thicknessFactor", -1},
      {"/extensions/KHR_materials_volume/attenuationDistance", 0},
      {"/extensions/KHR_materials_volume/attenuationColor", {0, 2, 0}},
      {"/extensions/KHR_materials_clearcoat/clearcoatFactor", 1.25},
      {"/extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", -0.25},
  };
  for (const auto& [path, value] : factors) {
    material() = {{"name", "wood"}};
    material()[nlohmann::json::json_pointer(path)] = value;
    expect_error({"material 'wood': " + path.substr(path.rfind('/') + 1) + " is ", "would be right"});
  }
}

TEST_F(GltfMaterialTest, MessagesStayOnOneLine) {
  material()["name"] = "two\nlines";
  material()["emissiveFactor"] = {2, 0, 0};
  expect_warning(
      "material 'two?lines': emissiveFactor is 2 0 0, where glTF ends at 1; it is read as it stands");
  EXPECT_EQ(load().materials.at(0).name, "two\nlines");
}

}  // namespace
}  // namespace qtrace
