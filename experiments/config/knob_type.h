// How each type of knob is read from JSON, written to JSON and described: in words and as a JSON Schema. A
// knob type is a specialisation of KnobType with read(), write(), describe() and schema(); groups of knobs
// need none.
#pragma once

#include "engine/core/check.h"
#include "engine/core/knob.h"
#include "experiments/config/nearest.h"
#include "experiments/files/json.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

namespace qtrace::experiments {

template <class T>
struct KnobType;

[[noreturn]] inline void reject_value(const std::string& path, const Json& value, const std::string& wanted,
                                      const std::string& hint = "") {
  fail("key '{}' is {} but must be {}{}", path, show(value), wanted, hint);
}

// " from 1 to 64", " of 1 or more", " of 64 or less" or "".
inline std::string range_text(double min, double max) {
  if (std::isfinite(min) && std::isfinite(max)) return fmt::format(" from {} to {}", min, max);
  if (std::isfinite(min)) return fmt::format(" of {} or more", min);
  if (std::isfinite(max)) return fmt::format(" of {} or less", max);
  return "";
}

// {"type": type} with the bounds that are finite.
inline Json number_schema(const char* type, double min, double max) {
  Json schema{{"type", type}};
  const auto bound = [&schema](const char* name, double value) {
    if (!std::isfinite(value)) return;
    // Whole ones without a point, as people write them.
    const bool is_whole = std::floor(value) == value && std::abs(value) < 1e15;
    schema[name] = is_whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
  };
  bound("minimum", min);
  bound("maximum", max);
  return schema;
}

// Whole numbers may be written 64, 64.0 or 6.4e1.
template <std::integral T>
requires(!std::same_as<T, bool> && sizeof(T) <= 4)  // double holds these exactly
    struct KnobType<T> {
  static double least(const KnobInfo& info) {
    return std::max(info.min, static_cast<double>(std::numeric_limits<T>::lowest()));
  }
  static double most(const KnobInfo& info) {
    return std::min(info.max, static_cast<double>(std::numeric_limits<T>::max()));
  }
  static std::string describe(const KnobInfo& info) {
    return fmt::format("a whole number from {:.0f} to {:.0f}", least(info), most(info));
  }
  static void read(const Json& json, const KnobInfo& info, const std::string& path, T& value) {
    if (!json.is_number()) reject_value(path, json, describe(info));
    const double number = json.get<double>();
    const bool fits = number >= least(info) && number <= most(info) && std::floor(number) == number;
    if (!fits) reject_value(path, json, describe(info));
    value = static_cast<T>(number);
  }
  static Json write(const T& value) { return value; }
  static Json schema(const KnobInfo& info) { return number_schema("integer", least(info), most(info)); }
};

template <>
struct KnobType<bool> {
  static std::string describe(const KnobInfo&) { return "true or false"; }
  static void read(const Json& json, const KnobInfo& info, const std::string& path, bool& value) {
    if (!json.is_boolean()) reject_value(path, json, describe(info));
    value = json.get<bool>();
  }
  static Json write(bool value) { return value; }
  static Json schema(const KnobInfo&) { return {{"type", "boolean"}}; }
};

template <>
struct KnobType<double> {
  static std::string describe(const KnobInfo& info) { return "a number" + range_text(info.min, info.max); }
  static void read(const Json& json, const KnobInfo& info, const std::string& path, double& value) {
    if (!json.is_number()) reject_value(path, json, describe(info));
    const double number = json.get<double>();
    const bool fits = std::isfinite(number) && number >= info.min && number <= info.max;
    if (!fits) reject_value(path, json, describe(info));
    value = number;
  }
  static Json write(double value) { return value; }
  static Json schema(const KnobInfo& info) { return number_schema("number", info.min, info.max); }
};

template <class T, std::size_t N>
struct KnobType<std::array<T, N>> {
  static std::string describe(const KnobInfo& info) {
    return fmt::format("a list of {}, each {}", N, KnobType<T>::describe(info));
  }
  static void read(const Json& json, const KnobInfo& info, const std::string& path, std::array<T, N>& value) {
    if (!json.is_array() || json.size() != N) reject_value(path, json, describe(info));
    for (std::size_t i = 0; i < N; ++i) {
      KnobType<T>::read(json[i], info, fmt::format("{}[{}]", path, i), value[i]);
    }
  }
  static Json write(const std::array<T, N>& value) {
    Json json = Json::array();
    for (const T& element : value) json.push_back(KnobType<T>::write(element));
    return json;
  }
  static Json schema(const KnobInfo& info) {
    return {{"type", "array"}, {"items", KnobType<T>::schema(info)}, {"minItems", N}, {"maxItems", N}};
  }
};

template <>
struct KnobType<std::string> {
  static std::string describe(const KnobInfo&) { return "a text"; }
  static void read(const Json& json, const KnobInfo& info, const std::string& path, std::string& value) {
    if (!json.is_string()) reject_value(path, json, describe(info));
    value = json.get<std::string>();
  }
  static Json write(const std::string& value) { return value; }
  static Json schema(const KnobInfo&) { return {{"type", "string"}}; }
};

template <class T>
requires std::is_enum_v<T>
struct KnobType<T> {
  static std::string describe(const KnobInfo&) {
    return fmt::format("one of {}", fmt::join(EnumNames<T>::values, ", "));
  }
  static void read(const Json& json, const KnobInfo& info, const std::string& path, T& value) {
    if (!json.is_string()) reject_value(path, json, describe(info));
    const auto& names = EnumNames<T>::values;
    const auto text = json.get<std::string>();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end()) {
      const std::vector<std::string> candidates(names.begin(), names.end());
      reject_value(path, json, describe(info), suggestion(text, candidates));
    }
    value = static_cast<T>(found - names.begin());
  }
  static Json write(T value) { return std::string(enum_name(value)); }
  static Json schema(const KnobInfo&) { return {{"enum", EnumNames<T>::values}}; }
};

}  // namespace qtrace::experiments
