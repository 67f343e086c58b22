// Shaders include in one direction, too: a folder only what stands before it, and no file itself by way of
// others.
#include "tests/support/includes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace qtrace {
namespace {

namespace fs = std::filesystem;
using test::IncludeGraph;
using test::includes_of;
using test::reaches;

// As in shaders/README.md.
const std::vector<std::string> kRooms{"shared", "geometry",   "material", "learning",   "sampling", "mis",
                                      "light",  "connection", "path",     "light_path", "passes"};

// By file, both below shaders/.
IncludeGraph read_shaders() {
  const fs::path root = fs::path(QTRACE_SOURCE_DIR) / "shaders";
  IncludeGraph all;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glsl" && extension != ".comp") continue;
    const std::vector<std::string> names = includes_of(entry.path());
    all[entry.path().lexically_relative(root).string()] = {names.begin(), names.end()};
  }
  return all;
}

std::string room_of(const std::string& file) { return file.substr(0, file.find('/')); }

std::ptrdiff_t place_of(const std::string& file) {
  return std::ranges::find(kRooms, room_of(file)) - kRooms.begin();
}

TEST(ShaderLayers, NoRoomIncludesALaterOne) {
  const IncludeGraph all = read_shaders();
  EXPECT_GT(all.size(), 30U);
  for (const auto& [file, includes] : all) {
    EXPECT_LT(place_of(file), std::ssize(kRooms)) << file << " is in no room of the list";
    for (const std::string& include : includes) {
      EXPECT_TRUE(all.contains(include))
          << file << " includes " << include << ", which is not below shaders/";
      EXPECT_LE(place_of(include), place_of(file)) << file << " includes " << include;
      EXPECT_FALSE(include.ends_with(".comp")) << file << " includes " << include;
    }
  }
}

TEST(ShaderLayers, NoFileIncludesItselfByWayOfOthers) {
  const IncludeGraph all = read_shaders();
  for (const auto& [file, includes] : all) {
    EXPECT_FALSE(reaches(all, file, file)) << file << " is included by what it includes";
  }
}

// What a file uses is at its top, where a reader looks for it.
TEST(ShaderLayers, IncludesStandBeforeAllElse) {
  const fs::path root = fs::path(QTRACE_SOURCE_DIR) / "shaders";
  for (const auto& [file, includes] : read_shaders()) {
    std::ifstream stream(root / file);
    bool is_head = true;
    for (std::string line; std::getline(stream, line);) {
      if (line.starts_with("#include")) {
        EXPECT_TRUE(is_head) << file << ": " << line;
      }
      is_head = is_head && (line.empty() || line.starts_with("//") || line.starts_with("#"));
    }
  }
}

}  // namespace
}  // namespace qtrace
