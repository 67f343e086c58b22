// Compressed vertex data, against the same data as it is: meshoptimizer and Draco, encoded here by their own
// libraries.
#include "tests/unit/gltf_builder.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>

namespace qtrace {
namespace {

// Two triangles of a square in the plane z = 2, with normals and four vertices.
const std::vector<float> kPositions{0, 0, 2, 4, 0, 2, 4, 4, 2, 0, 4, 2};
const std::vector<float> kNormals{0, 0, 1, 0.6F, 0, 0.8F, 0, 0.6F, 0.8F, 0, 0, 1};
const std::vector<std::uint32_t> kIndices{0, 1, 2, 0, 2, 3};

class GltfCompressionTest : public GltfTest {
 protected:
  GltfCompressionTest() {
    primitive_ = gltf.primitive(kPositions);
    primitive_["indices"] = gltf.add_indices(kIndices, kUnsignedInt);
    gltf.add_mesh({primitive_}, "shape");
    gltf.add_node({{"name", "thing"}, {"mesh", 0}});
    plain_ = load();
  }

  // The bytes at the end of the buffer; where they begin.
  std::size_t append(const std::vector<unsigned char>& bytes) {
    const std::size_t offset = gltf.binary.size();
    gltf.binary.append(bytes.begin(), bytes.end());
    gltf.binary.resize((gltf.binary.size() + 3) / 4 * 4);
    return offset;
  }

  void expect_same_as_plain() const {
    const Scene scene = load();
    EXPECT_TRUE(scene.warnings.empty()) << ::testing::PrintToString(scene.warnings);
    ASSERT_EQ(scene.triangles.size(), plain_.triangles.size());
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
      EXPECT_EQ(scene.triangles[i].position, plain_.triangles[i].position) << i;
      EXPECT_EQ(scene.triangles[i].normal, plain_.triangles[i].normal) << i;
    }
  }

  nlohmann::json& primitive() { return gltf.json["meshes"][0]["primitives"][0]; }

  nlohmann::json primitive_;
  Scene plain_;
};

class GltfMeshoptTest : public GltfCompressionTest {
 protected:
  GltfMeshoptTest() {
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(4, 12));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), kPositions.data(), 4, 12));
    compress(0, bytes, {{"byteStride", 12}, {"count", 4}, {"mode", "ATTRIBUTES"}});
    bytes.resize(meshopt_encodeIndexBufferBound(6, 4));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), kIndices.data(), 6));
    compress(1, bytes, {{"byteStride", 4}, {"count", 6}, {"mode", "TRIANGLES"}});
  }

  // The view keeps its length, but the bytes that it had are gone.
  void compress(std::size_t view, const std::vector<unsigned char>& bytes, nlohmann::json extension) {
    nlohmann::json& json = gltf.json["bufferViews"][view];
    std::fill_n(gltf.binary.begin() + json["byteOffset"].get<long>(), json["byteLength"].get<std::size_t>(),
                '\xff');
    extension["buffer"] = 0;
    extension["byteOffset"] = append(bytes);
    extension["byteLength"] = bytes.size();
    json["extensions"]["EXT_meshopt_compression"] = std::move(extension);
  }
  nlohmann::json& extension(std::size_t view) {
    return gltf.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
  }
};

TEST_F(GltfMeshoptTest, StandsForWhatWasCompressed) {
  expect_same_as_plain();
  std::vector<unsigned char> bytes(meshopt_encodeIndexSequenceBound(6, 4));
  bytes.resize(meshopt_encodeIndexSequence(bytes.data(), bytes.size(), kIndices.data(), 6));
  compress(1, bytes, {{"byteStride", 4}, {"count", 6}, {"mode", "INDICES"}});
  expect_same_as_plain();
}

TEST_F(GltfMeshoptTest, ABufferThatOnlyStandsForItNeedsNoBytes) {
  for (nlohmann::json& view : gltf.json["bufferViews"]) view["buffer"] = 1;
  gltf.json["buffers"] = {
      {{"byteLength", gltf.binary.size()}},
      {{"byteLength", 1000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  expect_same_as_plain();
  gltf.json["buffers"][1].erase("extensions");
  expect_same_as_plain();
  gltf.json["buffers"][1]["uri"] = "not_delivered.bin";
  expect_same_as_plain();
  gltf.json["bufferViews"][0].erase("extensions");
  expect_error({"buffer 1: 'not_delivered.bin': there is no such file"});
}

// As of vertex colours, whose filter the library does not know.
TEST_F(GltfMeshoptTest, ViewsThatNothingReadsMayBeOfAnyKind) {
  gltf.json["extensionsUsed"].push_back("KHR_meshopt_compression");
  const std::size_t view = gltf.json["bufferViews"].size();
  gltf.json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 16}});
  gltf.json["bufferViews"][view]["extensions"]["KHR_meshopt_compression"] = {
      {"buffer", 0}, {"byteLength", 5},      {"byteStride", 4},
      {"count", 4},  {"mode", "ATTRIBUTES"}, {"filter", "COLOR"}};
  expect_same_as_plain();
  gltf.json["accessors"].push_back(
      {{"bufferView", view}, {"componentType", kByte}, {"normalized", true}, {"count", 4}, {"type", "VEC3"}});
  for (const char* name : {"NORMAL", "COLOR_0"}) {
    primitive()["attributes"][name] = gltf.json["accessors"].size() - 1;
    expect_error({fmt::format("bufferView {} KHR_meshopt_compression", view)});
    primitive()["attributes"].erase(name);
  }
}

TEST_F(GltfMeshoptTest, FiltersAreUndone) {
  // Directions, octahedrally in four bytes each.
  const std::vector<float> normals{0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::array<std::int8_t, 16> encoded{};
  meshopt_encodeFilterOct(encoded.data(), 4, 4, 8, normals.data());
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(4, 4));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), encoded.data(), 4, 4));
  const std::size_t accessor = gltf.add_accessor(std::vector<std::int8_t>(12), "VEC3", kByte);
  gltf.json["accessors"][accessor]["normalized"] = true;
  gltf.json["bufferViews"][2]["byteStride"] = 4;
  compress(2, bytes, {{"byteStride", 4}, {"count", 4}, {"mode", "ATTRIBUTES"}, {"filter", "OCTAHEDRAL"}});
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = accessor;
  gltf.json["extensionsUsed"].push_back("KHR_mesh_quantization");
  expect_same_as_plain();
}

TEST_F(GltfMeshoptTest, RefusesWhatCannotBeDecoded) {
  const GltfBuilder good = gltf;
  const std::string place = "bufferView 0 EXT_meshopt_compression";
  extension(0)["count"] = 400;
  expect_error({place, "bytes cannot be decoded as 400 ATTRIBUTES of 12 bytes"});
  extension(0)["count"] = std::uint64_t{1} << 60U;
  expect_error({place, "count is 1152921504606846976; 1 or more, and no more than 4294967296 bytes"});
  extension(0)["count"] = 0;
  expect_error({place, "count is 0; 1 or more"});
  gltf = good;
  for (const int stride : {0, 10, 260}) {
    extension(0)["byteStride"] = stride;
    expect_error({place, "byteStride is ", "a multiple of 4 from 4 to 256"});
  }
  extension(1)["byteStride"] = 8;
  gltf = good;
  extension(1)["byteStride"] = 8;
  expect_error({"bufferView 1 EXT_meshopt_compression: byteStride is 8 with mode TRIANGLES; 2 or 4"});
  extension(1)["byteStride"] = 4;
  extension(1)["count"] = 5;
  expect_error({"count is 5; a multiple of 3"});
  gltf = good;
  extension(0)["filter"] = "QUATERNION";
  expect_error({"filter QUATERNION with byteStride 12 and mode ATTRIBUTES; 8 with ATTRIBUTES"});
  extension(0)["filter"] = "BLUR";
  expect_error({"bufferViews[0].extensions.EXT_meshopt_compression.filter is \"BLUR\"; one of NONE"});
  gltf = good;
  extension(0)["byteLength"] = gltf.binary.size() + 1;
  expect_error({place, "covers", "and buffer 0 has"});
  gltf = good;
  extension(0).erase("mode");
  expect_error({"bufferViews[0].extensions.EXT_meshopt_compression.mode is missing"});
}

class GltfDracoTest : public GltfCompressionTest {
 protected:
  GltfDracoTest() {
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    primitive_["attributes"]["NORMAL"] = gltf.add_floats("VEC3", kNormals);
    primitive() = primitive_;
    plain_ = load();
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2);
    const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::uint32_t face = 0; face < 2; ++face) {
      const auto set = [&](int attribute, const std::vector<float>& values) {
        const auto corner = [&](std::size_t i) {
          return values.data() + std::size_t{3} * kIndices[3 * face + i];
        };
        builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(face), corner(0), corner(1), corner(2));
      };
      set(normals, kNormals);
      set(positions, kPositions);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);  // keeps the order, and all bits
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    const auto* first = reinterpret_cast<const unsigned char*>(buffer.data());
    bytes_.assign(first, first + buffer.size());
    gltf.json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", append(bytes_)}, {"byteLength", bytes_.size()}});
    for (nlohmann::json& accessor : gltf.json["accessors"]) accessor.erase("bufferView");
    primitive() = primitive_;
    extension() = {{"bufferView", 3}, {"attributes", {{"NORMAL", 0}, {"POSITION", 1}}}};
  }
  nlohmann::json& extension() { return primitive()["extensions"]["KHR_draco_mesh_compression"]; }

  std::vector<unsigned char> bytes_;
};

TEST_F(GltfDracoTest, StandsForWhatWasCompressed) { expect_same_as_plain(); }

TEST_F(GltfDracoTest, RefusesWhatCannotBeDecoded) {
  const GltfBuilder good = gltf;
  gltf.json["bufferViews"][3]["byteLength"] = bytes_.size() / 2;
  expect_error({"mesh 'shape' primitive 0 KHR_draco_mesh_compression: its ", "bytes cannot be decoded: "});
  gltf = good;
  extension()["attributes"]["POSITION"] = 7;
  expect_error(
      {"mesh 'shape' primitive 0 KHR_draco_mesh_compression: POSITION is attribute 7, which the compressed "
       "data does not have"});
  gltf = good;
  extension()["attributes"]["TEXCOORD_0"] = 0;
  expect_error(
      {"mesh 'shape' primitive 0: TEXCOORD_0 is compressed with KHR_draco_mesh_compression and no "
       "attribute"});
  gltf = good;
  primitive()["mode"] = kStrip;
  expect_error({"has mode 5; 4, triangles, would be right"});
  gltf = good;
  extension()["bufferView"] = 4;
  expect_error({"extensions.KHR_draco_mesh_compression.bufferView is 4; an index below 4"});
  extension().erase("bufferView");
  expect_error({"extensions.KHR_draco_mesh_compression.bufferView is missing"});
}

}  // namespace
}  // namespace qtrace
