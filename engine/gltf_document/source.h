// What the parts of the glTF loader share: the parsed file, and messages that name it.
#pragma once

#include "engine/core/check.h"
#include "engine/core/text.h"
#include "engine/gltf_document/texture.h"

#include <tiny_gltf.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace qtrace::gltf {

struct Source {
  std::string file;  // as the user wrote it
  tinygltf::Model model;
  std::vector<std::string> warnings;
  std::size_t more_warnings = 0;  // that were left out
  Textures textures;

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    qtrace::fail("{}: {}", file, one_line(fmt::format(format, std::forward<Args>(args)...)));
  }

  template <class... Args>
  void check(bool condition, fmt::format_string<Args...> format, Args&&... args) const {
    if (!condition) fail(format, std::forward<Args>(args)...);
  }

  template <class... Args>
  void warn(fmt::format_string<Args...> format, Args&&... args) {
    constexpr std::size_t kMostWarnings = 100;
    if (warnings.size() == kMostWarnings) {
      ++more_warnings;
      return;
    }
    warnings.push_back(one_line(fmt::format(format, std::forward<Args>(args)...)));
  }
};

// "mesh 'teapot'", or "mesh 3" without a name.
inline std::string label(std::string_view kind, std::size_t index, const std::string& name) {
  constexpr std::size_t kLongest = 100;
  return name.empty() ? fmt::format("{} {}", kind, index)
                      : fmt::format("{} '{}'", kind, one_line(name, kLongest));
}

// Instead of fmt::join, in whose version 9 GCC 12 sees an overflow that is not there.
inline std::string joined(std::span<const std::string_view> words, std::string_view separator) {
  std::string text;
  for (const std::string_view word : words) text.append(text.empty() ? "" : separator).append(word);
  return text;
}

}  // namespace qtrace::gltf
