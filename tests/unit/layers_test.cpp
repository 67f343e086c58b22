// The way of the data has one direction: a folder includes only what stands before it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace qtrace {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kLayers{
    "engine/core",           "engine/scene",          "engine/gltf",         "engine/accel",
    "engine/cells",          "engine/gpu",            "engine/device_scene", "engine/tracer",
    "experiments/files",     "experiments/images",    "experiments/measure", "experiments/config",
    "experiments/runtime",   "experiments/reference", "experiments/records", "experiments/run",
    "experiments/study",     "experiments/commands"};

std::size_t layer_of(const std::string& path) {
  for (std::size_t i = 0; i < kLayers.size(); ++i) {
    if (path.starts_with(kLayers[i] + "/")) return i;
  }
  return kLayers.size();
}

std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex directive(R"(^\s*#include\s+"([^"]+)\")");
  std::vector<std::string> names;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, directive)) names.push_back(match[1]);
  }
  return names;
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
