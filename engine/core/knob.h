// How a knob is declared. A settings struct holds the value and its default; its visit_knobs() function,
// beside it, gives name, unit, range and help once. The JSON reader, the manifest, the key table and the
// schema are visitors over these declarations.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

namespace qtrace {

struct KnobInfo {
  std::string_view name;
  std::string_view unit;  // "" where the value has none
  std::string_view help;
  double min = -std::numeric_limits<double>::infinity();  // inclusive; numbers only
  double max = std::numeric_limits<double>::infinity();   // inclusive; numbers only
  // Of a knob that came after results had been kept: what programs without it did, as JSON. With that value
  // it does not enter hashes, so that what was kept is found again. Empty: it always enters them.
  std::string_view implied = "";
};

// Spellings of an enum's values in configs, in the order of the enumerators. Specialised beside each enum.
template <class Enum>
struct EnumNames;

template <class Enum>
constexpr std::string_view enum_name(Enum value) {
  return EnumNames<Enum>::values[static_cast<std::size_t>(value)];
}

}  // namespace qtrace
