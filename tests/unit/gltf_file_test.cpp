// Files, containers, JSON and buffers that must be refused.
#include "tests/unit/gltf_builder.h"

#include <cctype>

namespace qtrace {
namespace {

class GltfFileTest : public GltfTest {
 protected:
  GltfFileTest() { gltf.add_triangle(); }
  void expect_error_for(std::string_view bytes, std::initializer_list<std::string_view> parts) const {
    expect_error(folder.write("scene.glb", bytes), parts);
  }
  void expect_uri_error(const std::string& uri, std::initializer_list<std::string_view> parts) const {
    expect_error(folder.write("scene.gltf", gltf.gltf_with(uri)), parts);
  }
};

TEST_F(GltfFileTest, RefusesWhatIsNoFile) {
  expect_error(folder.path() / "none.glb", {"there is no such file"});
  expect_error(folder.path(), {"this is not a regular file"});
  expect_error(folder.write("empty.gltf", ""), {"the file is empty"});
  expect_error_for("glXF, with a text that follows", {"does not begin with 'glTF'"});
}

TEST_F(GltfFileTest, RefusesEveryTruncatedGlb) {
  const std::string bytes = gltf.glb();
  for (std::size_t size = 4; size < bytes.size(); ++size) {
    expect_error_for(bytes.substr(0, size), {"the .glb is truncated"});
    std::string patched = bytes.substr(0, size);  // as if it had been meant
    if (size < 12) continue;
    patched[8] = static_cast<char>(size & 0xffU);
    patched[9] = static_cast<char>(size >> 8U);
    const bool has_json_alone = patched.size() == bytes.size() - 8 - gltf.binary.size();
    expect_error_for(patched, {has_json_alone ? "buffer 0 has no uri" : "the .glb is truncated"});
  }
}

TEST_F(GltfFileTest, RefusesOtherContainers) {
  std::string bytes = gltf.glb();
  bytes[4] = 1;
  expect_error_for(bytes, {"container has version 1; version 2"});
  bytes = gltf.glb();
  bytes[16] = 'X';
  expect_error_for(bytes, {"the first chunk of the .glb is not JSON"});
  bytes = gltf.glb();
  bytes[14] = 0x7f;
  expect_error_for(bytes, {"the chunk at byte 12 declares", "left"});
}

TEST_F(GltfFileTest, RefusesBrokenJson) {
  expect_error(folder.write("scene.gltf", "{\n\"asset\": {,}}"),
               {"the JSON is not valid: parse error at line 2"});
  expect_error(folder.write("scene.gltf", "[1]"), {"the JSON is not an object"});
  expect_error(folder.write("scene.gltf", "{}"), {"asset.version is missing"});
  expect_error(folder.write("scene.gltf", R"({"asset": {"version": "1.0"}})"), {"asset.version is \"1.0\""});
  expect_error(folder.write("scene.gltf", R"({"asset": {"version": 1}})"),
               {"asset.version is 1; \"2.0\" would be right"});
  expect_error(folder.write("scene.gltf", R"({"asset": {"version": "2.0", "minVersion": "2.1"}})"),
               {"asset.minVersion is \"2.1\""});
  const std::string nest(100000, '[');
  expect_error(folder.write("scene.gltf", R"({"asset": {"version": "2.0", "extras": ["\"]", )" + nest),
               {"nests deeper than 64 levels"});
}

TEST_F(GltfFileTest, RefusesPropertiesOfTheWrongType) {
  gltf.json["nodes"][1]["mesh"] = "shape";
  expect_error({"nodes[1].mesh is \"shape\"; an index below 1, the number of meshes"});
  gltf.json["nodes"][1]["mesh"] = 0;
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", "0.5"}}}}};
  expect_error({"materials[0].pbrMetallicRoughness.metallicFactor is \"0.5\"; a finite number"});
  gltf.json["materials"] = {{{"doubleSided", 1}}};
  expect_error({"materials[0].doubleSided is 1; true or false"});
  gltf.json["materials"] = {{{"name", 7}}};
  expect_error({"materials[0].name is 7; a string"});
  gltf.json["materials"] = 3;
  expect_error({"materials is 3; an array"});
  gltf.json["materials"] = {3};
  expect_error({"materials[0] is 3; an object"});
}

// Each index of the format, one past the end of what it points into.
TEST_F(GltfFileTest, RefusesEveryIndexOutOfRange) {
  const GltfBuilder good = gltf;
  const std::vector<std::pair<std::string, std::string>> indices{
      {"/scene", "scenes"},
      {"/scenes/0/nodes/0", "nodes"},
      {"/nodes/0/children/0", "nodes"},
      {"/nodes/0/camera", "cameras"},
      {"/nodes/0/skin", "skins"},
      {"/nodes/1/mesh", "meshes"},
      {"/meshes/0/primitives/0/attributes/POSITION", "accessors"},
      {"/meshes/0/primitives/0/indices", "accessors"},
      {"/meshes/0/primitives/0/material", "materials"},
      {"/meshes/0/primitives/0/targets/0/POSITION", "accessors"},
      {"/accessors/0/bufferView", "bufferViews"},
      {"/bufferViews/0/buffer", "buffers"},
      {"/materials/0/normalTexture/index", "textures"},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", "textures"},
      {"/skins/0/joints/0", "nodes"},
  };
  for (const auto& [path, target] : indices) {
    for (const long long value : {1000LL, -1LL, 1LL << 32}) {  // tinygltf would take 1 << 32 for 0
      gltf = good;
      gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}}};
      gltf.json[nlohmann::json::json_pointer(path)] = value;
      const std::string leaf = path.substr(path.rfind('/') + 1);
      expect_error({fmt::format("is {}; an index below", value), "the number of " + target,
                    std::isdigit(leaf[0]) != 0 ? "[" + leaf + "]" : leaf});
    }
  }
}

TEST_F(GltfFileTest, RefusesBuffersShorterThanDeclared) {
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size() + 1}}};
  expect_error({"buffer 0: byteLength declares 37 bytes and there are 36"});
  gltf.json["buffers"] = {{{"byteLength", ~std::uint64_t{0}}}};
  expect_error({"buffer 0: byteLength declares 18446744073709551615 bytes"});
  gltf.json.erase("buffers");
  folder.write("data.bin", gltf.binary.substr(1));
  expect_uri_error("data.bin", {"buffer 0: byteLength declares 36 bytes and there are 35"});
  expect_uri_error("data:application/octet-stream;base64,AAAA",
                   {"buffer 0: byteLength declares 36", "are 3"});
}

TEST_F(GltfFileTest, RefusesBuffersThatCannotBeRead) {
  expect_uri_error("none.bin", {"buffer 0: 'none.bin'", "there is no such file"});
  expect_uri_error(".", {"buffer 0: '.'", "this is not a regular file"});
  expect_uri_error("data:application/octet-stream,AAAA",
                   {"buffer 0: the data URI begins with 'data:application/octet-stream'"});
  expect_uri_error("data:,", {"buffer 0: the data URI begins with 'data:'"});
  expect_uri_error("data:application/octet-stream;base64,!",
                   {"buffer 0: the data URI is empty or not base64"});
  gltf.json["buffers"] = {{{"byteLength", 36}}, {{"byteLength", 36}}};
  gltf.json["bufferViews"][0]["buffer"] = 1;
  expect_error({"buffer 1 has no uri; only buffer 0 of a .glb"});
}

TEST_F(GltfFileTest, DataUrisOfAnyMediaTypeHoldBytes) {
  for (const std::string type : {"audio/wav", "", "a/b;charset=utf-8"}) {
    std::string uri = gltf.data_uri();
    uri.replace(0, uri.find(";base64,"), "data:" + type);
    const Scene scene = load("scene.gltf", gltf.gltf_with(uri));
    EXPECT_EQ(scene.triangles.size(), 1U);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find("buffer 0: the data URI begins with 'data:" + type), std::string::npos);
  }
}

TEST_F(GltfFileTest, BuffersThatNothingReadsMayBeMissing) {
  gltf.json["buffers"] = {{{"byteLength", gltf.binary.size()}}, {{"byteLength", 99}, {"uri", "none.bin"}}};
  EXPECT_EQ(load().triangles.size(), 1U);
  // As of an image, of an animation, or of an attribute that nothing reads.
  const std::size_t view = gltf.json["bufferViews"].size(), accessor = gltf.json["accessors"].size();
  gltf.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 99}});
  gltf.json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", kFloat}, {"count", 3}, {"type", "SCALAR"}});
  gltf.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  gltf.json["animations"] = {{{"samplers", {{{"input", accessor}, {"output", accessor}}}}}};
  gltf.primitive_json()["attributes"]["_TEMPERATURE"] = accessor;
  EXPECT_EQ(load().triangles.size(), 1U);
  gltf.primitive_json()["attributes"]["NORMAL"] = accessor;
  expect_error({"buffer 1: 'none.bin': there is no such file"});
}

TEST_F(GltfFileTest, RefusesBuffersOutsideTheFolder) {
  const TempFolder other;
  const std::string outside = other.write("data.bin", gltf.binary).string();
  const std::string sibling = "../" + other.path().filename().string() + "/data.bin";
  expect_uri_error(outside, {"buffer 0: '" + outside + "' is an absolute path"});
  expect_uri_error(sibling, {"buffer 0: '" + sibling + "' leaves the scene's folder"});
  expect_uri_error("%2e%2E" + sibling.substr(2), {"buffer 0: '%2e%2E/", "leaves the scene's folder"});
  expect_uri_error("%2F" + outside.substr(1), {"is an absolute path"});
  expect_uri_error("file://" + outside, {"is not the path of a file"});
  expect_uri_error("data.bin%00.txt", {"is not the path of a file"});
  std::filesystem::create_symlink(outside, folder.path() / "link.bin");
  expect_uri_error("link.bin", {"buffer 0: 'link.bin' leaves the scene's folder"});
  std::filesystem::create_directory_symlink(other.path(), folder.path() / "sub");
  expect_uri_error("sub/data.bin", {"buffer 0: 'sub/data.bin' leaves the scene's folder"});
}

TEST_F(GltfFileTest, RefusesRequiredExtensions) {
  gltf.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_materials_sheen"};
  expect_error({"the required extension KHR_materials_sheen is not supported",
                "KHR_mesh_quantization, KHR_meshopt_compression"});
}

}  // namespace
}  // namespace qtrace
