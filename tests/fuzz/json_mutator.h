// Changes JSON as JSON: most changes of single bytes end in the parser and never reach what reads the values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace qtrace::fuzz {

// One to four changes: values replaced, copied over others, repeated, removed, renamed. Empty where the text
// is no JSON.
std::string mutate_json(std::string_view text, unsigned seed);

// libFuzzer's own changes of bytes.
std::string mutate_bytes(std::string_view bytes, std::size_t max_size);

// Copies the bytes to libFuzzer's buffer; zero, which is its word for failure, where they are too many.
std::size_t store(std::string_view bytes, std::uint8_t* data, std::size_t max_size);

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace qtrace::fuzz
