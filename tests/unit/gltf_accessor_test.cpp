// Vertex data that must be refused.
#include "tests/unit/gltf_builder.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace qtrace {
namespace {

class GltfAccessorTest : public GltfTest {
 protected:
  // Accessors and views: 0 is POSITION, 1 NORMAL, 2 TEXCOORD_0, 3 the indices.
  GltfAccessorTest() {
    gltf.add_triangle();
    attributes()["NORMAL"] = gltf.add_floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes()["TEXCOORD_0"] = gltf.add_floats("VEC2", {0, 0, 1, 0, 0, 1});
    gltf.primitive_json()["indices"] = gltf.add_indices({0, 1, 2}, kUnsignedShort);
  }
  nlohmann::json& attributes() { return gltf.primitive_json()["attributes"]; }
  nlohmann::json& accessor(std::size_t i) { return gltf.json["accessors"][i]; }
  nlohmann::json& view(std::size_t i) { return gltf.json["bufferViews"][i]; }
  void set_float(std::size_t view_index, std::size_t element, float value) {
    const std::size_t offset = view(view_index)["byteOffset"].get<std::size_t>() + 4 * element;
    std::memcpy(gltf.binary.data() + offset, &value, sizeof(value));
  }
  void set_indices(const std::vector<std::uint32_t>& indices, int component_type) {
    gltf.primitive_json()["indices"] = gltf.add_indices(indices, component_type);
  }
};

constexpr std::uint64_t kHuge = std::numeric_limits<std::uint64_t>::max();

TEST_F(GltfAccessorTest, IsAcceptedUnspoilt) {
  const Scene scene = load();
  EXPECT_EQ(scene.triangles.size(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfAccessorTest, RefusesAccessorsOutsideTheirView) {
  const std::string place = "mesh 'shape' primitive 0 POSITION (accessor 0)";
  for (const std::uint64_t count : {std::uint64_t{4}, kHuge, kHuge / 12 + 2}) {
    accessor(0)["count"] = count;
    expect_error({place, fmt::format("has {} elements", count), "bufferView 0 has room for 3"});
  }
  accessor(0)["count"] = 0;
  expect_error({place, "has a count of 0"});
  accessor(0)["count"] = 3;
  for (const std::uint64_t offset : {std::uint64_t{1}, std::uint64_t{36}, kHuge, kHuge - 35}) {
    accessor(0)["byteOffset"] = offset;
    expect_error({place, fmt::format("has 3 elements from byte {}", offset), "bufferView 0 has room for"});
  }
}

TEST_F(GltfAccessorTest, RefusesViewsOutsideTheirBuffer) {
  const std::size_t size = gltf.binary.size();
  view(0)["byteLength"] = size + 1;
  expect_error(
      {fmt::format("bufferView 0 covers {} bytes from byte 0, and buffer 0 has {}", size + 1, size)});
  view(0)["byteLength"] = kHuge;
  expect_error({"bufferView 0 covers 18446744073709551615 bytes from byte 0"});
  view(0)["byteLength"] = 36;
  view(0)["byteOffset"] = size - 35;
  expect_error({fmt::format("bufferView 0 covers 36 bytes from byte {}", size - 35)});
  view(0)["byteOffset"] = kHuge - 30;
  expect_error({"bufferView 0 covers 36 bytes from byte 18446744073709551585"});
}

TEST_F(GltfAccessorTest, RefusesBadStrides) {
  for (const int stride : {0, 3, 18, 256, -4}) {
    view(0)["byteStride"] = stride;
    expect_error({fmt::format("bufferViews[0].byteStride is {}; a multiple of 4 from 4 to 252", stride)});
  }
  view(0)["byteStride"] = 8;
  expect_error({"POSITION (accessor 0)", "bufferView 0 has a byteStride of 8; 12 or more"});
  view(0)["byteStride"] = 16;
  expect_error({"has 3 elements from byte 0, and bufferView 0 has room for 2"});
}

TEST_F(GltfAccessorTest, RefusesOtherTypes) {
  accessor(0)["type"] = "VEC2";
  expect_error({"mesh 'shape' primitive 0 POSITION (accessor 0) has the wrong type",
                "VEC3 of float, or of bytes or shorts would be right"});
  accessor(0)["type"] = "VEC3";
  accessor(1)["componentType"] = kShort;
  expect_error({"NORMAL (accessor 1) has the wrong type (VEC3 of component type 5122)", "VEC3 of float"});
  accessor(1)["componentType"] = kFloat;
  accessor(2)["componentType"] = kUnsignedInt;
  expect_error({"TEXCOORD_0 (accessor 2) has the wrong type", "VEC2 of float, or of bytes or shorts"});
  accessor(2)["componentType"] = kFloat;
  accessor(3)["componentType"] = kShort;
  expect_error({"indices (accessor 3) has the wrong type", "SCALAR of unsigned bytes, shorts or ints"});
  accessor(3)["componentType"] = 5130;
  expect_error({"accessors[3].componentType is 5130; one of 5120"});
  accessor(3)["componentType"] = "5123";
  expect_error({"accessors[3].componentType is \"5123\"; one of 5120"});
  accessor(3).erase("componentType");
  expect_error({"accessors[3].componentType is missing"});
}

TEST_F(GltfAccessorTest, RefusesMissingOrUnevenAttributes) {
  accessor(1)["count"] = 2;
  expect_error({"mesh 'shape' primitive 0 NORMAL (accessor 1) has a count of 2; 3, as POSITION has"});
  accessor(1)["count"] = 3;
  accessor(2)["count"] = 1;
  expect_error({"TEXCOORD_0 (accessor 2) has a count of 1; 3, as POSITION has"});
  attributes().erase("POSITION");
  const Scene nothing = load();
  EXPECT_TRUE(nothing.triangles.empty());
  EXPECT_EQ(nothing.warnings.at(0),
            "object 'thing': mesh 'shape' primitive 0 has no POSITION; it is skipped");
  gltf.primitive_json().erase("attributes");
  expect_error({"meshes[0].primitives[0].attributes is missing"});
}

TEST_F(GltfAccessorTest, RefusesIndicesOfNoVertex) {
  set_indices({0, 1, 3}, kUnsignedShort);
  expect_error({"mesh 'shape' primitive 0 indices (accessor 4): element 2 is 3; an index below 3"});
  set_indices({0, 1, 0x7fffffff}, kUnsignedInt);
  expect_error({"indices (accessor 5): element 2 is 2147483647; an index below 3"});
}

TEST_F(GltfAccessorTest, RefusesPrimitiveRestart) {
  set_indices({0, 255, 2}, kUnsignedByte);
  expect_error({"indices (accessor 4): element 1 is 255, the primitive restart value"});
  set_indices({0, 65535, 2}, kUnsignedShort);
  expect_error({"element 1 is 65535, the primitive restart value"});
  set_indices({0, 0xffffffff, 2}, kUnsignedInt);
  expect_error({"element 1 is 4294967295, the primitive restart value"});
}

TEST_F(GltfAccessorTest, RefusesIncompleteTriangles) {
  set_indices({0, 1, 2, 0}, kUnsignedByte);
  expect_error({"mesh 'shape' primitive 0 has 4 corners; a multiple of 3"});
  set_indices({0, 1}, kUnsignedByte);
  gltf.primitive_json()["mode"] = kStrip;
  expect_error({"mesh 'shape' primitive 0 has 2 corners; 3 or more"});
  gltf.primitive_json()["mode"] = 7;
  expect_error({"meshes[0].primitives[0].mode is 7; one of 0 1 2 3 4 5 6"});
}

TEST_F(GltfAccessorTest, RefusesVertexDataThatIsNotFinite) {
  const std::vector<std::pair<std::size_t, const char*>> floats{{0, "POSITION (accessor 0): element 1"},
                                                                {1, "NORMAL (accessor 1): element 1"},
                                                                {2, "TEXCOORD_0 (accessor 2): element 1"}};
  const GltfBuilder good = gltf;
  for (const auto& [accessor_index, place] : floats) {
    for (const float value : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
      gltf = good;
      set_float(accessor_index, 3, value);
      expect_error({"mesh 'shape' primitive 0", place, "finite numbers would be right"});
    }
  }
}

TEST_F(GltfAccessorTest, RefusesMoreTrianglesThanItCanHold) {
  const std::vector<std::uint32_t> many(std::size_t{3} << 16U, 0);
  set_indices(many, kUnsignedByte);
  const nlohmann::json primitives(1025, gltf.primitive_json());  // 2^26 + 2^16 triangles
  gltf.json["meshes"][0]["primitives"] = primitives;
  expect_error({"the scene has more than 67108864 triangles"});
}

}  // namespace
}  // namespace qtrace
