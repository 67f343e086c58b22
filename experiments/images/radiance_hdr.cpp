#include "experiments/images/radiance_hdr.h"

#include "engine/core/check.h"
#include "engine/core/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

namespace qtrace::experiments {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

// Rows of other widths have no runs of the newer kind, whose header has 15 bits for the width.
constexpr std::size_t kLeastWidthOfRuns = 8;
constexpr std::size_t kMostWidthOfRuns = 0x7fff;

// The words of a line, divided by spaces.
std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (!line.empty()) {
    const std::size_t space = std::min(line.find_first_of(" \t\r"), line.size());
    if (space > 0) words.push_back(line.substr(0, space));
    line.remove_prefix(std::min(space + 1, line.size()));
  }
  return words;
}

// Nothing but a number, or else 0.
template <class T>
T number_of(std::string_view text) {
  T number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : T{};
}

// A line's numbers multiply what the lines before it say.
void multiply_exposure(std::string_view name, std::string_view line, HdrHeader& header) {
  const std::vector<std::string_view> words = words_of(line.substr(name.size()));
  const bool is_grey = words.size() == 1;
  for (int c = 0; c < 3; ++c) {
    const std::size_t word = is_grey ? 0 : static_cast<std::size_t>(c);
    const double factor = word < words.size() ? number_of<double>(words[word]) : 0;
    check(std::isfinite(factor) && factor > 0,
          "its header says '{}', but '{}' must be followed by positive numbers", one_line(line, 60), name);
    header.exposure[c] *= factor;
  }
}

void read_variable(std::string_view line, HdrHeader& header) {
  constexpr std::string_view kFormat = "FORMAT=";
  if (line.starts_with(kFormat)) {
    const std::vector<std::string_view> words = words_of(line.substr(kFormat.size()));
    check(words.size() == 1 && words[0] == "32-bit_rle_rgbe",
          "its header says '{}', but only FORMAT=32-bit_rle_rgbe is read", one_line(line, 60));
  }
  for (const std::string_view name : {"EXPOSURE=", "COLORCORR="}) {
    if (line.starts_with(name)) multiply_exposure(name, line, header);
  }
}

// The line after the header's variables: "-Y height +X width".
void read_resolution(std::string_view line, HdrHeader& header) {
  const std::vector<std::string_view> words = words_of(line);
  if (words.size() == 4 && words[0] == "-Y" && words[2] == "+X") {
    header.height = number_of<std::uint32_t>(words[1]);
    header.width = number_of<std::uint32_t>(words[3]);
  }
  check(header.width > 0 && header.height > 0,
        "its size is given as '{}', but only '-Y height +X width' is read: rows from the top, pixels from "
        "the left",
        one_line(line, 60));
}

// Bytes from the front of a file.
class Bytes {
 public:
  explicit Bytes(std::string_view rest) : rest_(rest) {}

  std::size_t left() const { return rest_.size(); }
  std::uint8_t peek(std::size_t i) const { return static_cast<std::uint8_t>(rest_[i]); }
  std::uint8_t next() {
    check(!rest_.empty(), "the file ends there");
    const std::uint8_t byte = peek(0);
    rest_.remove_prefix(1);
    return byte;
  }

 private:
  std::string_view rest_;
};

// The rows before Radiance 1.4 (1991), and of files without runs: a pixel (1, 1, 1, n) repeats the one before
// it n times; such pixels in succession give n from its lowest byte up.
void read_pixels(Bytes& bytes, std::span<Rgbe> row) {
  unsigned shift = 0;
  for (std::size_t i = 0; i < row.size();) {
    Rgbe pixel;
    for (std::uint8_t& byte : pixel) byte = bytes.next();
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      row[i++] = pixel;
      shift = 0;
      continue;
    }
    check(i > 0, "it begins with a run of a pixel that is not there");
    check(shift < 32, "a run is too long");
    const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
    check(count <= row.size() - i, "a run of {} pixels does not end in it", count);
    std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(i), count, row[i - 1]);
    i += count;
    shift += 8;
  }
}

// One of the four bytes of all pixels: more than 128, and as many less 128 copies of the next byte; or else
// so many bytes as they are.
void read_component(Bytes& bytes, std::span<Rgbe> row, std::size_t component) {
  for (std::size_t i = 0; i < row.size();) {
    const std::size_t code = bytes.next();
    const bool is_run = code > 128;
    const std::size_t count = is_run ? code - 128 : code;
    check(count > 0 && count <= row.size() - i, "a run of {} bytes does not end in it", count);
    std::uint8_t byte = is_run ? bytes.next() : std::uint8_t{0};
    for (std::size_t end = i + count; i < end; ++i) {
      if (!is_run) byte = bytes.next();
      row[i][component] = byte;
    }
  }
}

// Rows with runs by component begin with 2, 2 and the width.
bool has_component_runs(const Bytes& bytes, std::size_t width) {
  return width >= kLeastWidthOfRuns && width <= kMostWidthOfRuns && bytes.left() >= 4 && bytes.peek(0) == 2 &&
         bytes.peek(1) == 2 && bytes.peek(2) < 128;
}

void read_row(Bytes& bytes, std::span<Rgbe> row) {
  if (!has_component_runs(bytes, row.size())) return read_pixels(bytes, row);
  for (int i = 0; i < 2; ++i) bytes.next();
  const std::size_t high = bytes.next();
  const std::size_t width = high << 8U | bytes.next();
  check(width == row.size(), "it has {} pixels where the header says {}", width, row.size());
  for (std::size_t component = 0; component < 4; ++component) read_component(bytes, row, component);
}

}  // namespace

HdrHeader read_hdr_header(std::string_view bytes) {
  HdrHeader header;
  const auto next_line = [&] {
    const std::size_t end = bytes.find('\n', header.size);
    check(end != std::string_view::npos, "the file ends within its header");
    const std::string_view line = bytes.substr(header.size, end - header.size);
    header.size = end + 1;
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  };
  check(next_line().starts_with(kHdrMagic), "its first line must begin with {}", kHdrMagic);
  for (std::string_view line = next_line(); !line.empty(); line = next_line()) read_variable(line, header);
  read_resolution(next_line(), header);
  return header;
}

glm::dvec3 rgbe_radiance(const Rgbe& rgbe) {
  if (rgbe[3] == 0) return glm::dvec3(0);
  return glm::dvec3(rgbe[0], rgbe[1], rgbe[2]) * std::ldexp(1.0, rgbe[3] - (128 + 8));
}

std::vector<glm::vec3> read_hdr_pixels(std::string_view bytes, const HdrHeader& header) {
  Bytes rest(bytes.substr(header.size));
  std::vector<glm::vec3> pixels;  // grows with the rows that are there, whatever the header says
  std::vector<Rgbe> row(header.width);
  for (std::uint32_t y = 0; y < header.height; ++y) {
    try {
      read_row(rest, row);
    } catch (const Error& error) {
      fail("its row {} of {} is damaged: {}", y, header.height, error.what());
    }
    for (const Rgbe& rgbe : row) pixels.emplace_back(rgbe_radiance(rgbe) / header.exposure);
  }
  return pixels;
}

}  // namespace qtrace::experiments
