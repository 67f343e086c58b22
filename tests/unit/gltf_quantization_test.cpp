// Vertex data of integers (KHR_mesh_quantization).
#include "tests/unit/gltf_builder.h"

#include <cmath>

namespace qtrace {
namespace {

class GltfQuantizationTest : public GltfTest {
 protected:
  GltfQuantizationTest() {
    gltf.add_triangle();
    gltf.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"];
  }
  // An attribute of the triangle, each vertex padded to four bytes.
  template <class T>
  void set(const char* name, const std::vector<T>& values, const char* type, int component,
           bool is_normalized) {
    const std::size_t accessor = gltf.add_accessor(values, type, component);
    gltf.json["accessors"][accessor]["normalized"] = is_normalized;
    gltf.primitive_json()["attributes"][name] = accessor;
    const auto view = gltf.json["accessors"][accessor]["bufferView"].get<std::size_t>();
    gltf.json["bufferViews"][view]["byteStride"] = 4 * sizeof(T);
    gltf.json["accessors"][accessor]["count"] = 3;
  }
};

TEST_F(GltfQuantizationTest, PositionsAreNumbersOrFractions) {
  const std::vector<std::int16_t> shorts{-300, 0, 7, 0, 300, 0, 7, 0, -300, 200, 7, 0};
  set("POSITION", shorts, "VEC3", kShort, false);
  EXPECT_EQ(load().triangles.at(0).position[0], glm::vec3(-300, 0, 7));
  EXPECT_EQ(load().triangles.at(0).position[2], glm::vec3(-300, 200, 7));
  const std::vector<std::int8_t> bytes{-128, 0, 127, 0, 127, 0, 127, 0, -127, 127, 127, 0};
  set("POSITION", bytes, "VEC3", kByte, true);
  EXPECT_EQ(load().triangles.at(0).position[0], glm::vec3(-1, 0, 1)) << "-128 is no less than -1";
  EXPECT_EQ(load().triangles.at(0).position[2], glm::vec3(-1, 1, 1));
  const std::vector<std::uint16_t> fractions{0, 0, 65535, 0, 65535, 0, 65535, 0, 0, 13107, 65535, 0};
  set("POSITION", fractions, "VEC3", kUnsignedShort, true);
  EXPECT_FLOAT_EQ(load().triangles.at(0).position[2].y, 0.2F);
  EXPECT_TRUE(load().warnings.empty());
}

TEST_F(GltfQuantizationTest, NormalsAndTextureCoordinates) {
  const std::vector<std::int8_t> normals{0, 0, 127, 0, 0, 90, 90, 0, 0, 0, 127, 0};
  set("NORMAL", normals, "VEC3", kByte, true);
  EXPECT_FLOAT_EQ(load().triangles.at(0).normal[1].y, std::sqrt(0.5F));
  const std::vector<std::int16_t> uv{0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 0, 0};
  set("TEXCOORD_0", uv, "VEC2", kShort, false);
  EXPECT_EQ(load().triangles.at(0).uv[0], glm::vec2(0, 2));
  EXPECT_EQ(load().triangles.at(0).uv[1], glm::vec2(-3, 0));
  set("NORMAL", normals, "VEC3", kByte, false);
  expect_error(
      {"NORMAL (accessor",
       "has the wrong type (VEC3 of component type 5120); VEC3 of float, or of normalized bytes or shorts"});
}

TEST_F(GltfQuantizationTest, IsReadWithAWarningWhereItIsNotDeclared) {
  gltf.json.erase("extensionsUsed");
  gltf.json.erase("extensionsRequired");
  const std::vector<std::uint8_t> positions{0, 0, 1, 0, 3, 0, 1, 0, 0, 3, 1, 0};
  set("POSITION", positions, "VEC3", kUnsignedByte, false);
  expect_warning(
      "mesh 'shape': POSITION has integers as KHR_mesh_quantization allows, which extensionsUsed does not "
      "declare; "
      "it is read as if it did");
  EXPECT_EQ(load().triangles.at(0).position[1], glm::vec3(3, 0, 1));
}

}  // namespace
}  // namespace qtrace
