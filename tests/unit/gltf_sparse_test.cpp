// Accessors whose elements are given one by one, or not at all.
#include "tests/unit/gltf_builder.h"

#include <array>

#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"

namespace qtrace {
namespace {

// A triangle whose POSITION, accessor 0, has two elements replaced.
class GltfSparseTest : public GltfTest {
 protected:
  GltfSparseTest() {
    gltf.add_triangle();
    values_ = gltf.add_floats("VEC3", {0, 0, 5, 0, 7, 5});
    indices_ = gltf.add_indices({0, 2}, kUnsignedShort);
    accessor()["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", view_of(indices_)}, {"componentType", kUnsignedShort}}},
        {"values", {{"bufferView", view_of(values_)}}}};
  }
  nlohmann::json& accessor() { return gltf.json["accessors"][0]; }
  nlohmann::json& sparse() { return accessor()["sparse"]; }
  nlohmann::json& view_of(std::size_t accessor) { return gltf.json["accessors"][accessor]["bufferView"]; }
  std::array<glm::vec3, 3> positions() const { return load().triangles.at(0).position; }

  std::size_t values_ = 0, indices_ = 0;
};

using Corners = std::array<glm::vec3, 3>;

TEST_F(GltfSparseTest, ElementsTakeThePlaceOfOthers) {
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 5), glm::vec3(1, 0, 0), glm::vec3(0, 7, 5)}));
  // Also where the view has a stride, which the expanded one has not.
  const std::size_t wide = gltf.add_floats("VEC3", {9, 9, 9, 0, 0, 0, 1, 2, 3, 0, 0, 0, 9, 9, 9});
  gltf.json["bufferViews"][view_of(wide).get<std::size_t>()]["byteStride"] = 24;
  accessor()["bufferView"] = view_of(wide);
  EXPECT_EQ(positions()[1], glm::vec3(1, 2, 3));
  EXPECT_EQ(positions()[2], glm::vec3(0, 7, 5));
}

TEST_F(GltfSparseTest, WithoutDataTheOthersAreZero) {
  accessor().erase("bufferView");
  sparse()["indices"] = {{"bufferView", view_of(gltf.add_indices({1, 2}, kUnsignedByte))},
                         {"componentType", kUnsignedByte}};
  EXPECT_EQ(positions(), (Corners{glm::vec3(0), glm::vec3(0, 0, 5), glm::vec3(0, 7, 5)}));
  accessor().erase("sparse");
  EXPECT_TRUE(load().triangles.empty());  // three times the same point
}

TEST_F(GltfSparseTest, IndicesMayBeSparseToo) {
  gltf.primitive_json()["indices"] = gltf.add_indices({0, 0, 0}, kUnsignedByte);
  const std::size_t last = gltf.json["accessors"].size() - 1;
  gltf.json["accessors"][last].erase("bufferView");
  gltf.json["accessors"][last]["sparse"] = {
      {"count", 2},
      {"indices",
       {{"bufferView", view_of(gltf.add_indices({1, 2}, kUnsignedInt))}, {"componentType", kUnsignedInt}}},
      {"values", {{"bufferView", view_of(gltf.add_indices({2, 1}, kUnsignedByte))}}}};
  EXPECT_EQ(positions(), (Corners{glm::vec3(0, 0, 5), glm::vec3(0, 7, 5), glm::vec3(1, 0, 0)}));
}

TEST_F(GltfSparseTest, RefusesWhatDoesNotFit) {
  const GltfBuilder good = gltf;
  for (const int count : {0, 4}) {
    sparse()["count"] = count;
    expect_error(
        {fmt::format("accessor 0: its sparse.count is {}; 1 to 3, its count, would be right", count)});
  }
  sparse()["count"] = 3;
  expect_error({"accessor 0 sparse.indices has 3 elements from byte 0, and its bufferView has room for 2"});
  gltf = good;
  sparse()["values"]["byteOffset"] = 4;
  expect_error({"accessor 0 sparse.values has 2 elements from byte 4, and its bufferView has room for 1"});
  gltf = good;
  for (const auto& indices : {std::vector<std::uint32_t>{0, 3}, {2, 0}, {1, 1}}) {
    sparse()["indices"]["bufferView"] = view_of(gltf.add_indices(indices, kUnsignedShort));
    expect_error({"accessor 0 sparse.indices: element 1 is ", "; indices below 3 that grow would be right"});
  }
  for (const char* missing : {"/count", "/indices", "/values", "/indices/bufferView",
                              "/indices/componentType", "/values/bufferView"}) {
    gltf = good;
    nlohmann::json flat = sparse().flatten();
    nlohmann::json rest = nlohmann::json::object();
    for (const auto& [key, value] : flat.items()) {
      if (!key.starts_with(missing)) rest[key] = value;
    }
    sparse() = rest.unflatten();
    expect_error({"accessors[0].sparse.", "is missing"});
  }
  gltf = good;
  sparse()["indices"]["componentType"] = kShort;
  expect_error({"accessors[0].sparse.indices.componentType is 5122; one of 5121 5123 5125"});
  sparse()["indices"] = {{"bufferView", 99}, {"componentType", kUnsignedShort}};
  expect_error({"accessors[0].sparse.indices.bufferView is 99; an index below"});
}

TEST_F(GltfSparseTest, ASmallFileCannotAskForAllMemory) {
  accessor().erase("bufferView");
  for (const std::uint64_t count : {std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
    accessor()["count"] = count;
    expect_error(
        {"accessor 0: accessors that are sparse or have no bufferView ask for more than 4294967296 bytes"});
  }
}

}  // namespace
}  // namespace qtrace
