#include "experiments/config/config_errors.h"

#include "engine/core/check.h"
#include "engine/core/text.h"
#include "experiments/files/atomic_file.h"

#include <algorithm>

namespace qtrace::experiments {
namespace {

// Configs that hold one member of the whole each: of groups every member, of the sweep every axis.
std::vector<Json> single_members(const Json& config) {
  const std::vector<KeyRow> knobs = list_knobs(ExperimentKeys{});
  const auto is_knob = [&](const std::string& key) {  // whose value is an object, as a place of the camera
    return std::ranges::find(knobs, key, &KeyRow::key) != knobs.end();
  };
  std::vector<Json> singles;
  for (const auto& [key, value] : config.items()) {
    if (key == "$schema") continue;
    if (value.is_object() && !value.empty() && !is_knob(key)) {
      for (const auto& [member, inner] : value.items()) singles.push_back({{key, {{member, inner}}}});
    } else if (key == "sweep" && value.is_array()) {
      for (const Json& axis : value) singles.push_back({{key, Json::array({axis})}});
    } else {
      singles.push_back({{key, value}});
    }
  }
  return singles;
}

Json nested(const Json& config) {
  Json result = Json::object();
  merge(result, config);
  return result;
}

// Throws Error where one member is wrong.
void check_member(const Json& single) {
  ExperimentKeys keys;
  read_knobs(nested(single), keys);
  for (const Axis& axis : keys.sweep.axes) {
    for (const AxisValue& value : axis.values) {
      try {
        RunConfig run;
        read_knobs(nested(value.overrides), run);
      } catch (const Error& error) {
        fail("'{}' of sweep axis '{}': {}", value.label, axis.name, error.what());
      }
    }
  }
}

std::vector<std::string> errors_of_members(const std::filesystem::path& file) {
  std::vector<std::string> errors;
  const Json config = parse_json(read_file(file));
  if (!config.is_object()) return errors;
  for (const Json& single : single_members(config)) {
    try {
      check_member(single);
    } catch (const Error& error) {
      const std::string line = fmt::format("{}: {}", file.string(), one_line(error.what()));
      if (std::ranges::count(errors, line) == 0) errors.push_back(line);
    }
  }
  return errors;
}

}  // namespace

std::vector<std::string> config_errors(const std::filesystem::path& file,
                                       const std::vector<std::string>& sets, Experiment& experiment) {
  try {
    experiment = load_experiment(file, sets);
    return {};
  } catch (const Error& error) {
    std::vector<std::string> errors;
    try {
      if (sets.empty()) errors = errors_of_members(file);  // a setting may have put a key right
    } catch (const Error&) {
      // Unreadable or no JSON, as `error` says.
    }
    return errors.empty() ? std::vector<std::string>{error.what()} : errors;
  }
}

}  // namespace qtrace::experiments
