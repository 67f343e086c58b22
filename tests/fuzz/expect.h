// What must hold of every answer; where it does not, the fuzzer keeps the input.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace qtrace::fuzz {

inline void expect(bool condition, const char* what, const std::string& found) {
  if (condition) return;
  std::fprintf(stderr, "fuzz: %s: %s\n", what, found.c_str());
  std::abort();
}

// One line of text that a terminal and a manifest can take.
inline void expect_message(const std::string& message) {
  constexpr std::size_t kLongest = 2000;
  bool is_plain = !message.empty() && message.size() <= kLongest;
  for (const char c : message) is_plain = is_plain && static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  expect(is_plain, "a message must be one line of at most 2000 bytes, without control characters", message);
  try {
    (void)nlohmann::json(message).dump();
  } catch (const nlohmann::json::exception&) {
    expect(false, "a message must be UTF-8", message);
  }
}

}  // namespace qtrace::fuzz
