// Texts of files, as messages show them: whatever a file holds, a message is one line of UTF-8 that ends.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace qtrace {

// Bytes of the UTF-8 character in front (Unicode 15, table 3-7); 0 where there is none.
inline std::size_t character_size(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.empty()) return 0;
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t size = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (text.size() < size) return 0;
  const unsigned char least = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned char most = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (byte(1) < least || byte(1) > most) return 0;
  for (std::size_t i = 2; i < size; ++i) {
    if (byte(i) < 0x80 || byte(i) > 0xBF) return 0;
  }
  return size;
}

// At most `max_size` bytes of whole characters, with "..." in place of what is left out.
inline std::string shortened(std::string_view text, std::size_t max_size) {
  if (text.size() <= max_size) return std::string(text);
  std::size_t end = max_size;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80) --end;
  return std::string(text.substr(0, end)) + "...";
}

// '?' for control characters and for bytes that are no UTF-8.
inline std::string one_line(std::string_view text, std::size_t max_size = 1000) {
  std::string line;
  while (!text.empty() && line.size() <= max_size) {
    const std::size_t size = character_size(text);
    const bool is_control = size == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7f);
    line += size == 0 || is_control ? "?" : text.substr(0, size);
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return shortened(line, max_size);
}

}  // namespace qtrace
