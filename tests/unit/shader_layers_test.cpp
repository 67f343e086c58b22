// Shaders include in one direction, too: a folder only what stands before it, and no file itself by way of
// others.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace qtrace {
namespace {

namespace fs = std::filesystem;

// As in shaders/README.md.
const std::vector<std::string> kRooms{"shared",   "geometry", "material", "learning",
                                      "sampling", "light",    "path",     "passes"};

// By file, both below shaders/.
using Includes = std::map<std::string, std::vector<std::string>>;

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

Includes read_shaders() {
  const fs::path root = fs::path(QTRACE_SOURCE_DIR) / "shaders";
  Includes all;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glsl" && extension != ".comp") continue;
    all[entry.path().lexically_relative(root).string()] = includes_of(entry.path());
  }
  return all;
}

std::string room_of(const std::string& file) { return file.substr(0, file.find('/')); }

std::ptrdiff_t place_of(const std::string& file) {
  return std::ranges::find(kRooms, room_of(file)) - kRooms.begin();
}

// The files from the first one seen twice on the way from `file`, to itself; none where there is no circle.
std::vector<std::string> circle_from(const std::string& file, const Includes& all,
                                     std::vector<std::string> way) {
  const auto seen = std::ranges::find(way, file);
  if (seen != way.end()) return {seen, way.end()};
  way.push_back(file);
  const auto found = all.find(file);
  if (found == all.end()) return {};
  for (const std::string& include : found->second) {
    std::vector<std::string> circle = circle_from(include, all, way);
    if (!circle.empty()) return circle;
  }
  return {};
}

TEST(ShaderLayers, NoRoomIncludesALaterOne) {
  const Includes all = read_shaders();
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
  const Includes all = read_shaders();
  for (const auto& [file, includes] : all) {
    std::string text;
    for (const std::string& step : circle_from(file, all, {})) text += step + " -> ";
    EXPECT_EQ(text, "");
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
