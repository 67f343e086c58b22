// Small files that ask for much. Found by fuzzing, or looked for because of what it found.
#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "tests/support/cpu_time.h"
#include "tests/unit/gltf_builder.h"

namespace qtrace {
namespace {

constexpr int kPoints = 0;
constexpr int kTriangleStrip = 5;

class GltfLimitsTest : public GltfTest {
 protected:
  // `nodes` nodes that share a mesh of `count` times the same primitive.
  void add_instances(const nlohmann::json& primitive, int count, int nodes) {
    const std::size_t mesh =
        gltf.add_mesh(std::vector<nlohmann::json>(static_cast<std::size_t>(count), primitive));
    for (int i = 0; i < nodes; ++i) gltf.add_node({{"mesh", mesh}});
  }
  // A strip of 1000 triangles.
  nlohmann::json strip() {
    std::vector<float> positions;
    for (int i = 0; i < 1002; ++i) {
      for (const int x : {i / 2, i % 2, 0}) positions.push_back(static_cast<float>(x));
    }
    nlohmann::json primitive = gltf.primitive(positions);
    primitive["mode"] = kTriangleStrip;
    return primitive;
  }
  nlohmann::json points() {
    nlohmann::json primitive = gltf.primitive({0, 0, 0});
    primitive["mode"] = kPoints;
    return primitive;
  }
};

// 60 kB that stand for 200 million triangles: all of them were walked through before they were counted.
TEST_F(GltfLimitsTest, TrianglesAreCountedBeforeTheyAreRead) {
  add_instances(strip(), 200, 1000);
  const double start = test::cpu_seconds();
  expect_error({"the scene has more than 67108864 triangles, which is the most supported"});
  EXPECT_LT(test::cpu_seconds() - start, 2);
}

TEST_F(GltfLimitsTest, PrimitivesAreCountedToo) {
  gltf.add_triangle();
  add_instances(points(), 3000, 3000);
  const double start = test::cpu_seconds();
  expect_error({"the nodes' meshes have more than 4194304 primitives, which is the most supported"});
  EXPECT_LT(test::cpu_seconds() - start, 2);
}

TEST_F(GltfLimitsTest, LimitsCanBeLower) {
  add_instances(strip(), 2, 3);
  const std::string bytes = gltf.glb();
  const auto count = [&](const SceneLimits& limits) {
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    return parse_gltf({data, bytes.size()}, "a.glb", {}, limits).triangles.size();
  };
  EXPECT_EQ(count({6000, 6, 0}), 6000U);
  EXPECT_THROW(count({5999, 6, 0}), Error);
  EXPECT_THROW(count({6000, 5, 0}), Error);
}

// A file of 1 MB that is read as often as the scene's author likes.
TEST_F(GltfLimitsTest, BuffersThatShareAFileAreCounted) {
  constexpr std::size_t kSize = std::size_t{1} << 20U;
  gltf.add_triangle();
  folder.write("data.bin", std::string(kSize, '\0'));
  const nlohmann::json buffer = {{"byteLength", kSize}, {"uri", "data.bin"}};
  gltf.json["buffers"] = std::vector<nlohmann::json>(8193, buffer);
  for (std::size_t i = 0; i < 8193; ++i) {
    gltf.json["skins"].push_back({{"joints", {0}}, {"inverseBindMatrices", gltf.json["accessors"].size()}});
    gltf.json["accessors"].push_back({{"bufferView", gltf.json["bufferViews"].size()},
                                      {"componentType", kFloat},
                                      {"count", 1},
                                      {"type", "MAT4"}});
    gltf.json["bufferViews"].push_back({{"buffer", i}, {"byteLength", 64}});
  }
  expect_error(folder.write("scene.gltf", gltf.json.dump()),
               {"the buffers ask for more than 8589934592 bytes of files, which is the most supported"});
}

TEST_F(GltfLimitsTest, ManyWarningsAreCounted) {
  gltf.add_triangle();
  add_instances(points(), 300, 2);
  const Scene scene = load();
  ASSERT_EQ(scene.warnings.size(), 101U);
  EXPECT_NE(scene.warnings[99].find("mesh 1 primitive 99 holds a set of points"), std::string::npos)
      << scene.warnings[99];
  EXPECT_EQ(scene.warnings[100], "502 more warnings are left out");  // two objects are omitted
}

// The fuzzer's own seeds, which have each property that the loader reads.
TEST_F(GltfLimitsTest, TheFuzzerStartsFromScenesThatAreRead) {
  const std::filesystem::path seeds = QTRACE_SOURCE_DIR "/tests/fuzz/corpus/gltf";
  const Scene scene = load_gltf(seeds / "every_property.gltf");
  EXPECT_EQ(scene.triangles.size(), 12U) << "lamps are cut out of what lies in their plane";
  EXPECT_EQ(scene.objects.size(), 3U);
  std::size_t read = 0;
  for (const auto& seed : std::filesystem::directory_iterator(seeds)) {
    EXPECT_NO_THROW(load_gltf(seed.path())) << seed.path();
    ++read;
  }
  EXPECT_GE(read, 9U);
}

// A name of 100 kB stood in every warning, with the line breaks of other texts.
TEST_F(GltfLimitsTest, MessagesAreOneLineOfUtf8WhateverTheFileHolds) {
  gltf.add_triangle();
  gltf.json["extensionsUsed"] = {"a\nb\x1b[31m"};
  gltf.json["meshes"][0]["name"] = "\u20ac" + std::string(100'000, 'x');
  gltf.json["nodes"][1].erase("name");
  gltf.add_node({{"mesh", 0}, {"scale", {0, 0, 0}}});
  const Scene scene = load();
  ASSERT_GE(scene.warnings.size(), 2U);
  EXPECT_EQ(scene.warnings[0], "extension a?b?[31m is not modelled; the scene is read without it");
  for (const std::string& warning : scene.warnings) EXPECT_LT(warning.size(), 1000U);
  expect_error(folder.write("scene.gltf", "\"\xff\xe2\x82"), {"last read: '\"?'"});
}

}  // namespace
}  // namespace qtrace
