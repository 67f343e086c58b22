#include "experiments/files/npy.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"

#include <bit>
#include <charconv>
#include <cstring>
#include <regex>
#include <string>
#include <string_view>

namespace qtrace::experiments {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr std::string_view kMagic{"\x93NUMPY\x01\x00", 8};  // and version 1.0
constexpr std::size_t kLengthBytes = 2;                     // of the header that follows
constexpr std::size_t kAlignment = 64;                      // of the first number
constexpr std::size_t kLongestHeader = 1024;                // NumPy's own is 118 bytes

template <class T>
constexpr std::string_view kType = "";
template <>
constexpr std::string_view kType<float> = "<f4";
template <>
constexpr std::string_view kType<std::uint32_t> = "<u4";

std::string header_text(std::string_view type, std::size_t rows, std::size_t columns) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}", type, rows, columns);
  const std::size_t before = kMagic.size() + kLengthBytes;
  const std::size_t end = before + header.size() + 1;
  header.append((kAlignment - end % kAlignment) % kAlignment, ' ');
  return header + '\n';
}

// A Python literal with sorted keys, as NumPy writes it.
const std::regex& header_pattern() {
  static const std::regex pattern(
      R"(\{'descr': '([^']*)', 'fortran_order': (True|False), 'shape': \(([0-9, ]*)\), \} *\n)");
  return pattern;
}

bool read_shape(const std::string& text, std::size_t& rows, std::size_t& columns) {
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, rows);
  if (first.ec != std::errc() || end - first.ptr < 3 || std::string_view(first.ptr, 2) != ", ") return false;
  const auto second = std::from_chars(first.ptr + 2, end, columns);
  return second.ec == std::errc() && second.ptr == end;
}

}  // namespace

template <class T>
std::string npy_text(std::size_t columns, std::span<const T> values) {
  check(columns > 0 && values.size() % columns == 0, "{} values do not fill rows of {}", values.size(),
        columns);
  const std::string header = header_text(kType<T>, values.size() / columns, columns);
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string content(kMagic);
  content.append(reinterpret_cast<const char*>(&length), kLengthBytes);
  content += header;
  content.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return content;
}

template <class T>
void write_npy(const std::filesystem::path& file, std::size_t columns, std::span<const T> values) {
  write_file(file, npy_text(columns, values));
}

template <class T>
NpyTable<T> read_npy(const std::filesystem::path& file) {
  const std::string content = read_file(file);
  const std::size_t before = kMagic.size() + kLengthBytes;
  check(content.size() >= before && content.starts_with(kMagic), "{}: is no NumPy file of version 1.0",
        file.string());
  std::uint16_t length = 0;
  std::memcpy(&length, content.data() + kMagic.size(), kLengthBytes);
  const std::string header = content.substr(before, length);
  std::smatch parts;
  check(length <= kLongestHeader && std::regex_match(header, parts, header_pattern()),
        "{}: the header is damaged", file.string());
  check(parts[1].str() == kType<T>, "{}: holds numbers of type '{}' where '{}' is needed", file.string(),
        parts[1].str(), kType<T>);
  NpyTable<T> table;
  check(parts[2].str() == "False" && read_shape(parts[3], table.rows, table.columns),
        "{}: has shape ({}){} where rows and columns are needed", file.string(), parts[3].str(),
        parts[2].str() == "True" ? " by columns" : "");
  const std::size_t held = content.size() - before - header.size();
  const bool fits = table.columns > 0 && held / sizeof(T) / table.columns == table.rows &&
                    held == table.rows * table.columns * sizeof(T);
  check(fits, "{}: holds {} bytes of numbers, which is not {} x {} of them; the file is truncated or damaged",
        file.string(), held, table.rows, table.columns);
  table.values.resize(table.rows * table.columns);
  std::memcpy(table.values.data(), content.data() + before + header.size(), held);
  return table;
}

template std::string npy_text(std::size_t, std::span<const float>);
template std::string npy_text(std::size_t, std::span<const std::uint32_t>);
template void write_npy(const std::filesystem::path&, std::size_t, std::span<const float>);
template void write_npy(const std::filesystem::path&, std::size_t, std::span<const std::uint32_t>);
template NpyTable<float> read_npy(const std::filesystem::path&);
template NpyTable<std::uint32_t> read_npy(const std::filesystem::path&);

}  // namespace qtrace::experiments
