// The table of what is read (docs/gltf.md) says what the reader does: a file for each of its rows.
#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "engine/gltf_document/support.h"
#include "tests/unit/gltf_builder.h"
#include "tests/unit/picture_files.h"

#include <functional>
#include <map>

namespace qtrace {
namespace gltf {

// googletest names a row by it.
static void PrintTo(const Support& row, std::ostream* out) { *out << row.name; }

}  // namespace gltf
namespace {

using gltf::Treatment;
using Change = std::function<void(GltfBuilder&)>;

nlohmann::json& material(GltfBuilder& file) { return file.material(); }

const std::string kImage = png_of(128, 128, 255);

// Of an image by the coordinates that the triangle then has.
void set_texture(GltfBuilder& file, nlohmann::json& info) {
  file.primitive_json()["attributes"]["TEXCOORD_0"] = file.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
  info["index"] = file.add_texture(kImage);
}

void set_extension(GltfBuilder& file, const std::string& name, nlohmann::json& owner,
                   const nlohmann::json& value) {
  file.json["extensionsUsed"] = {name};
  owner["extensions"][name] = value;
}

// Each makes a file that has what the row is about, where the plain one has it not.
const std::map<std::string_view, Change>& examples() {
  static const std::map<std::string_view, Change> all{
      {"asset.version", [](GltfBuilder& f) { f.json["asset"]["version"] = "2.1"; }},
      {"asset.minVersion", [](GltfBuilder& f) { f.json["asset"]["minVersion"] = "2.1"; }},
      {"scene, scenes", [](GltfBuilder&) {}},
      {"nodes: matrix, translation, rotation, scale",
       [](GltfBuilder& f) {
         f.json["nodes"][1]["scale"] = {-1, 1, 1};
       }},
      {"nodes: camera", [](GltfBuilder&) {}},
      {"nodes: skin",
       [](GltfBuilder& f) {
         f.json["skins"] = {{{"joints", {0}}}};
         f.json["nodes"][1]["skin"] = 0;
       }},
      {"nodes: weights, meshes: weights, targets",
       [](GltfBuilder& f) {
         f.primitive_json()["targets"] = {{{"POSITION", 0}}};
         f.json["nodes"][1]["weights"] = {1};
       }},
      {"primitives: POSITION, NORMAL, indices, mode 4 to 6",
       [](GltfBuilder& f) { f.primitive_json()["mode"] = kFan; }},
      {"primitives: mode 0 to 3",
       [](GltfBuilder& f) {
         f.json["meshes"][0]["primitives"].push_back(f.primitive_json());
         f.json["meshes"][0]["primitives"][1]["mode"] = kLines;
       }},
      {"primitives: TEXCOORD_0",
       [](GltfBuilder& f) {
         f.primitive_json()["attributes"]["TEXCOORD_0"] = f.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
       }},
      {"primitives: TEXCOORD_1",
       [](GltfBuilder& f) {
         f.primitive_json()["attributes"]["TEXCOORD_1"] = f.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
         material(f)["normalTexture"] = {{"index", f.add_texture(kImage)}, {"texCoord", 1}};
       }},
      {"primitives: TANGENT",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         f.primitive_json()["attributes"]["NORMAL"] = f.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
         f.primitive_json()["attributes"]["TANGENT"] =
             f.add_floats("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
       }},
      {"primitives: COLOR_0",
       [](GltfBuilder& f) {
         f.primitive_json()["attributes"]["COLOR_0"] = f.add_floats("VEC3", {1, 0, 0, 0, 1, 0, 0, 0, 1});
       }},
      {"accessors: sparse, without a bufferView",
       [](GltfBuilder& f) {
         f.primitive_json()["attributes"]["NORMAL"] = f.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
         const std::size_t indices = f.add_indices({1}, kUnsignedShort);
         f.json["accessors"][1]["sparse"] = {
             {"count", 1},
             {"indices", {{"bufferView", indices}, {"componentType", kUnsignedShort}}},
             {"values", {{"bufferView", 1}}}};
       }},
      {"buffers: uri",
       [](GltfBuilder& f) {
         f.json["buffers"] = {{{"byteLength", f.binary.size()}, {"uri", f.data_uri()}}};
       }},
      {"textures: source, sampler",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         f.json["textures"][0]["sampler"] = 0;
         f.json["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
       }},
      {"samplers: minFilter",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         f.json["textures"][0]["sampler"] = 0;
         f.json["samplers"] = {{{"minFilter", 9984}}};
       }},
      {"images", [](GltfBuilder& f) { set_texture(f, material(f)["normalTexture"]); }},
      {"materials: baseColorFactor, metallicFactor, roughnessFactor",
       [](GltfBuilder& f) { material(f)["pbrMetallicRoughness"]["roughnessFactor"] = 0.5; }},
      {"materials: emissiveFactor",
       [](GltfBuilder& f) {
         material(f)["emissiveFactor"] = {1, 1, 1};
       }},
      {"materials: baseColorTexture, metallicRoughnessTexture, normalTexture, emissiveTexture",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["emissiveTexture"]);
         material(f)["emissiveFactor"] = {1, 1, 1};
       }},
      {"materials: occlusionTexture",
       [](GltfBuilder& f) { set_texture(f, material(f)["occlusionTexture"]); }},
      {"materials: alphaMode, alphaCutoff",
       [](GltfBuilder& f) {
         material(f)["alphaMode"] = "MASK";
         material(f)["alphaCutoff"] = 0.25;
       }},
      {"materials: doubleSided", [](GltfBuilder& f) { material(f)["doubleSided"] = true; }},
      {"cameras: perspective, orthographic",
       [](GltfBuilder& f) {
         f.json["cameras"][0] = {{"type", "orthographic"},
                                 {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 9}}}};
       }},
      {"animations",
       [](GltfBuilder& f) {
         f.json["animations"] = {{{"name", "walk"}}};
       }},
      {"extras", [](GltfBuilder& f) { f.json["nodes"][1]["extras"]["mood"] = "calm"; }},
      {"extensionsRequired",
       [](GltfBuilder& f) {
         f.json["extensionsRequired"] = f.json["extensionsUsed"] = {"KHR_techniques_webgl"};
       }},
      {"overlapping surfaces in one plane",
       [](GltfBuilder& f) {
         material(f)["emissiveFactor"] = {1, 1, 1};
         f.json["nodes"].push_back({{"mesh", f.add_mesh({f.primitive({0, 0, 0, 0.5F, 0, 0, 0, 0.5F, 0})})}});
         f.json["scenes"][0]["nodes"].push_back(f.json["nodes"].size() - 1);
       }},
      {"EXT_mesh_gpu_instancing",
       [](GltfBuilder& f) {
         set_extension(f, "EXT_mesh_gpu_instancing", f.json["nodes"][1],
                       {{"attributes", {{"TRANSLATION", f.add_floats("VEC3", {0, 0, 1})}}}});
       }},
      {"KHR_lights_punctual",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_lights_punctual", f.json, {{"lights", {{{"type", "point"}}}}});
         set_extension(f, "KHR_lights_punctual", f.json["nodes"][1], {{"light", 0}});
       }},
      {"KHR_materials_clearcoat",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_clearcoat", material(f), {{"clearcoatFactor", 1}});
       }},
      {"KHR_materials_transmission",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_transmission", material(f), {{"transmissionFactor", 1}});
       }},
      {"KHR_materials_unlit",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_unlit", material(f), nlohmann::json::object());
       }},
      {"KHR_materials_volume",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_volume", material(f), {{"thicknessFactor", 1}});
       }},
      {"KHR_materials_emissive_strength",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_emissive_strength", material(f), {{"emissiveStrength", 3}});
       }},
      {"KHR_materials_ior",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_ior", material(f), {{"ior", 1.33}});
         material(f)["pbrMetallicRoughness"]["metallicFactor"] = 0;
       }},
      {"KHR_materials_specular",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_specular", material(f), {{"specularFactor", 0.5}});
       }},
      {"KHR_mesh_quantization",
       [](GltfBuilder& f) {
         f.json["extensionsUsed"] = {"KHR_mesh_quantization"};
         const std::vector<std::int16_t> normals{0, 0, 32767, 0, 0, 32767, 0, 0, 32767};
         const std::size_t accessor = f.add_accessor(normals, "VEC3", kShort);
         f.json["accessors"][accessor]["normalized"] = true;
         f.primitive_json()["attributes"]["NORMAL"] = accessor;
       }},
      {"KHR_node_visibility",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_node_visibility", f.json["nodes"][1], {{"visible", false}});
         f.add_node({{"mesh", 0}});
       }},
      {"EXT_texture_avif",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         set_extension(f, "EXT_texture_avif", f.json["textures"][0], {{"source", 0}});
       }},
      {"EXT_texture_webp",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         set_extension(f, "EXT_texture_webp", f.json["textures"][0], {{"source", 0}});
       }},
      {"KHR_texture_basisu",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         set_extension(f, "KHR_texture_basisu", f.json["textures"][0], {{"source", 0}});
       }},
      {"KHR_texture_transform",
       [](GltfBuilder& f) {
         set_texture(f, material(f)["normalTexture"]);
         set_extension(f, "KHR_texture_transform", material(f)["normalTexture"], {{"rotation", 1}});
       }},
      {"KHR_materials_variants",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_variants", f.json, {{"variants", {{{"name", "red"}}}}});
       }},
      {"KHR_xmp_json_ld",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_xmp_json_ld", f.json["asset"], {{"packet", 0}});
       }},
      {"any other extension",
       [](GltfBuilder& f) {
         set_extension(f, "KHR_materials_sheen", material(f), nlohmann::json::object());
       }},
  };
  return all;
}

class GltfSupport : public GltfTest, public ::testing::WithParamInterface<gltf::Support> {};

TEST_P(GltfSupport, IsAsTheTableSays) {
  const gltf::Support& row = GetParam();
  const auto example = examples().find(row.name);
  ASSERT_NE(example, examples().end()) << "no file has " << row.name;
  gltf.add_triangle();
  example->second(gltf);
  if (row.treatment == Treatment::refused) return expect_error({});
  const Scene scene = load();
  EXPECT_EQ(scene.warnings.empty(), shows_in_full(row.treatment)) << ::testing::PrintToString(scene.warnings);
  if (row.name.find('_') == std::string_view::npos || row.name.find(' ') != std::string_view::npos) return;
  gltf.json["extensionsRequired"] = {row.name};
  if (may_be_required(row.treatment)) {
    EXPECT_EQ(load().warnings, scene.warnings);
  } else {
    expect_error({"the required extension", row.name});
  }
}

// All but compressed data, whose files tests/unit/gltf_compression_test.cpp has.
std::vector<gltf::Support> rows_with_examples() {
  std::vector<gltf::Support> rows;
  for (const gltf::Support& row : gltf::kSupport) {
    if (row.name.find("_compression") == std::string_view::npos) rows.push_back(row);
  }
  return rows;
}

INSTANTIATE_TEST_SUITE_P(Table, GltfSupport, ::testing::ValuesIn(rows_with_examples()), [](const auto& row) {
  std::string name;
  for (const char c : row.param.name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
});

}  // namespace
}  // namespace qtrace
