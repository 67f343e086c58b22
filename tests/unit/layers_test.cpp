// The way of the data has one direction: a folder includes only what stands before it, and no units stand in
// a circle.
#include "tests/support/includes.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace qtrace {
namespace {

namespace fs = std::filesystem;
using test::IncludeGraph;
using test::includes_of;
using test::reaches;

const std::vector<std::string> kLayers{
    "engine/core",         "engine/scene",       "engine/picture",      "engine/gltf_document",
    "engine/gltf",         "engine/accel",       "engine/cells",        "engine/gpu",
    "engine/device_scene", "engine/tracer",      "experiments/files",   "experiments/images",
    "experiments/measure", "experiments/config", "experiments/runtime", "experiments/reference",
    "experiments/records", "experiments/run",    "experiments/study",   "experiments/commands"};

std::size_t layer_of(const std::string& path) {
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    if (path.starts_with(kLayers[i] + "/")) return i;
  }
  return kLayers.size();
}

// A unit is a .h with its .cpp: the path without its extension.
std::string unit_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

// What each unit of the layers includes.
IncludeGraph units() {
  const fs::path root = QTRACE_SOURCE_DIR;
  IncludeGraph graph;
  for (const std::string& layer : kLayers) {
    for (const auto& entry : fs::directory_iterator(root / layer)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      const std::string unit = unit_of(entry.path().lexically_relative(root).string());
      std::set<std::string>& included = graph[unit];
      for (const std::string& include : includes_of(entry.path())) {
        if (unit_of(include) != unit) included.insert(unit_of(include));
      }
    }
  }
  return graph;
}

TEST(Layers, NoUnitsStandInACircle) {
  const IncludeGraph graph = units();
  ASSERT_GT(graph.size(), 100U);
  for (const auto& [unit, included] : graph) {
    EXPECT_FALSE(reaches(graph, unit, unit)) << unit << " is included by what it includes";
  }
}

TEST(Layers, NoFolderHoldsMoreUnitsThanOneFindsThingsIn) {
  constexpr int kMost = 25;
  std::map<std::string, int> folders;
  for (const auto& [unit, included] : units()) ++folders[unit.substr(0, unit.rfind('/'))];
  ASSERT_EQ(folders.size(), kLayers.size());
  for (const auto& [folder, count] : folders) EXPECT_LE(count, kMost) << folder;
}

TEST(Layers, NoFolderIncludesALaterOne) {
  const fs::path root = QTRACE_SOURCE_DIR;
  int checked = 0;
  for (std::size_t layer = 0; layer < kLayers.size(); ++layer) {
    for (const auto& entry : fs::recursive_directory_iterator(root / kLayers[layer])) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      for (const std::string& include : includes_of(entry.path())) {
        SCOPED_TRACE(entry.path().string() + " includes " + include);
        // Beside the layers there are two files that host and shaders share, and what the build writes.
        if (include == "shaders/shared/structs.glsl") {
          EXPECT_EQ(kLayers[layer], "engine/gpu");
          continue;
        }
        if (include == "shaders/shared/variants.glsl") {
          EXPECT_EQ(kLayers[layer], "engine/tracer");
          continue;
        }
        EXPECT_TRUE(fs::exists(root / include)) << "includes are written from the root of the repository";
        EXPECT_LE(layer_of(include), layer);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100);
}

}  // namespace
}  // namespace qtrace
