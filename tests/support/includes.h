// Who includes what, in C++ and in shaders.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace qtrace::test {

// The names in quotes after #include, in their order.
inline std::vector<std::string> includes_of(const std::filesystem::path& file) {
  static const std::regex directive(R"(^\s*#include\s+"([^"]+)\")");
  std::vector<std::string> names;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, directive)) names.push_back(match[1]);
  }
  return names;
}

// By file or unit: what it includes.
using IncludeGraph = std::map<std::string, std::set<std::string>>;

// Whether `to` is reached from `from` by one include or more.
inline bool reaches(const IncludeGraph& graph, const std::string& from, const std::string& to) {
  std::set<std::string> seen;
  std::vector<std::string> waiting{from};
  while (!waiting.empty()) {
    const auto unit = graph.find(waiting.back());
    waiting.pop_back();
    if (unit == graph.end()) continue;
    for (const std::string& next : unit->second) {
      if (next == to) return true;
      if (seen.insert(next).second) waiting.push_back(next);
    }
  }
  return false;
}

}  // namespace qtrace::test
