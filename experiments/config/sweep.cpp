#include "experiments/config/sweep.h"

#include "engine/core/check.h"
#include "engine/core/text.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace qtrace::experiments {
namespace {

constexpr std::size_t kMaxId = 200;           // bytes; file systems allow 255 for a name
constexpr std::size_t kMaxAxes = kMaxId / 4;  // "a=b,"

const std::vector<std::string>& override_keys() {
  static const std::vector<std::string> keys = settable_keys(list_knobs(RunConfig{}));
  return keys;
}

// Of a value that is an object, as a camera's place: it is read as a whole, which says what is wrong with it.
bool is_within_a_value(const std::string& path) {
  static const std::vector<KeyRow> knobs = list_knobs(RunConfig{});
  return std::ranges::any_of(knobs, [&](const KeyRow& knob) { return path.starts_with(knob.key + '.'); });
}

// Overrides may set any knob of a run but the name, which belongs to the experiment as a whole.
void check_override_key(const std::string& place, const std::string& key) {
  const std::vector<std::string>& keys = override_keys();
  check(key != "name", "{} sets 'name', which belongs to the whole experiment", place);
  if (std::find(keys.begin(), keys.end(), key) != keys.end() || is_within_a_value(key)) return;
  fail("{} sets the unknown key '{}'{}", place, key, suggestion(key, keys));
}

AxisValue plain_value(const std::string& key, const Json& value) {
  AxisValue result;
  result.label = show(value, true);
  if (key == "scene" && value.is_string()) result.label = std::filesystem::path(result.label).stem().string();
  result.slug = value.is_number() ? result.label : slug(result.label);
  result.overrides[key] = value;
  return result;
}

Axis read_values(const std::string& key, const Json& values) {
  check_override_key("a sweep axis", key);
  Axis axis{key, key == "seed", {}};
  std::set<Json> seen;
  for (const Json& value : values) {
    check(seen.insert(value).second, "sweep axis '{}' has the value {} twice", key, show(value));
    axis.values.push_back(plain_value(key, value));
  }
  return axis;
}

Axis read_groups(const std::string& label, const Json& groups) {
  Axis axis{label, false, {}};
  for (const auto& [name, overrides] : groups.items()) {
    const std::string place = fmt::format("group '{}' of sweep axis '{}'", name, label);
    check(overrides.is_object(), "{} is {} but must be an object of overrides", place, show(overrides));
    std::set<std::string> paths;
    for (const std::string& path : leaf_paths(overrides)) {
      check_override_key(place, path);
      check(paths.insert(path).second, "{} sets '{}' twice", place, path);
    }
    axis.values.push_back({name, slug(name), overrides});
  }
  return axis;
}

void check_axis(const Axis& axis) {
  check(!slug(axis.name).empty(), "sweep axis '{}' needs a name with letters or digits", axis.name);
  check(!axis.values.empty(), "sweep axis '{}' has no values; give it one at least or remove it", axis.name);
  std::map<std::string, std::string> labels;  // by slug
  for (const AxisValue& value : axis.values) {
    check(!value.slug.empty(), "sweep axis '{}': '{}' needs letters or digits, to name a folder", axis.name,
          value.label);
    const auto [first, is_new] = labels.emplace(value.slug, value.label);
    check(is_new, "sweep axis '{}': '{}' and '{}' would have the same folder name '{}'; rename one",
          axis.name, first->second, value.label, value.slug);
  }
}

std::set<std::string> axis_paths(const Axis& axis) {
  std::set<std::string> paths;
  for (const AxisValue& value : axis.values) {
    for (std::string& path : leaf_paths(value.overrides)) paths.insert(std::move(path));
  }
  return paths;
}

// Where two axes set one key, the ids would claim a value that the run does not have.
void check_independent(const Axis& first, const Axis& second) {
  check(first.name != second.name, "two sweep axes are called '{}'; merge or rename one", first.name);
  for (const std::string& a : axis_paths(first)) {
    for (const std::string& b : axis_paths(second)) {
      check(!paths_overlap(a, b), "sweep axes '{}' and '{}' both set '{}'; only one may", first.name,
            second.name, a.size() > b.size() ? a : b);
    }
  }
}

Axis read_axis(const Json& json, const std::string& path) {
  check(
      json.is_object() && json.size() == 1,
      "key '{}' is {} but must be an object with one key: {{\"key\": [values]}} or {{\"label\": {{\"name\": "
      "{{overrides}}}}}}",
      path, show(json));
  const std::string name = json.begin().key();
  const Json& values = json.begin().value();
  check(values.is_structured(), "sweep axis '{}' is {} but must be a list of values or an object of groups",
        name, show(values));
  return values.is_array() ? read_values(name, values) : read_groups(name, values);
}

SweepPoint make_point(const std::vector<Axis>& axes, const std::vector<std::size_t>& choice) {
  SweepPoint point;
  point.overrides = Json::object();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const AxisValue& value = axes[i].values[choice[i]];
    point.id += (i == 0 ? "" : ",") + slug(axes[i].name) + '=' + value.slug;
    if (!axes[i].is_seed) point.configuration += (point.configuration.empty() ? "" : " / ") + value.label;
    point.labels.push_back(value.label);
    merge(point.overrides, value.overrides);
  }
  if (axes.empty()) point.id = "run";
  if (point.configuration.empty()) point.configuration = "all";
  return point;
}

// Counts up like an odometer; false after the last combination.
bool advance(std::vector<std::size_t>& choice, const std::vector<Axis>& axes) {
  for (std::size_t i = axes.size(); i-- > 0;) {
    if (++choice[i] < axes[i].values.size()) return true;
    choice[i] = 0;
  }
  return false;
}

}  // namespace

std::string KnobType<Sweep>::describe(const KnobInfo&) { return "a list of axes"; }

void KnobType<Sweep>::read(const Json& json, const KnobInfo& info, const std::string& path, Sweep& sweep) {
  if (!json.is_array()) reject_value(path, json, describe(info));
  check(json.size() <= kMaxAxes, "key '{}' has {} axes but {} are the most: a run's id names a value of each",
        path, json.size(), kMaxAxes);
  sweep.axes.clear();
  for (std::size_t i = 0; i < json.size(); ++i) {
    Axis axis = read_axis(json[i], fmt::format("{}[{}]", path, i));
    check_axis(axis);
    for (const Axis& other : sweep.axes) check_independent(other, axis);
    sweep.axes.push_back(std::move(axis));
  }
}

Json KnobType<Sweep>::schema(const KnobInfo&) {
  return {{"type", "array"}, {"maxItems", kMaxAxes}, {"items", {{"$ref", "#/$defs/axis"}}}};
}

Json KnobType<Sweep>::write(const Sweep& sweep) {
  Json axes = Json::array();
  for (const Axis& axis : sweep.axes) {
    Json groups = Json::object();
    for (const AxisValue& value : axis.values) groups[value.label] = value.overrides;
    axes.push_back(Json{{axis.name, groups}});
  }
  return axes;
}

void check_size(const Sweep& sweep, std::size_t base, const SweepLimits& limits) {
  double runs = 1;
  std::size_t size = base;
  for (const Axis& axis : sweep.axes) {
    std::size_t longest = 0;
    for (const AxisValue& value : axis.values) longest = std::max(longest, value.overrides.dump().size());
    runs *= static_cast<double>(axis.values.size());
    size += longest;
  }
  check(runs <= limits.runs, "key 'sweep' asks for {:.10g} runs but {} are the most; divide it", runs,
        limits.runs);
  check(runs * static_cast<double>(size) <= limits.text,
        "key 'sweep' asks for {} runs with configs of up to {} bytes, but {} bytes are the most for all; "
        "divide it",
        runs, size, limits.text);
}

void expand_sweep(const Sweep& sweep, const std::function<void(const SweepPoint&)>& use) {
  std::vector<std::size_t> choice(sweep.axes.size(), 0);
  do {
    const SweepPoint point = make_point(sweep.axes, choice);
    check(point.id.size() <= kMaxId,
          "run '{}' has an id of {} bytes, but {} are the most; shorten its axis labels",
          shortened(point.id, kMaxId), point.id.size(), kMaxId);
    use(point);
  } while (advance(choice, sweep.axes));
}

std::string slug(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool plain =
        (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9') || lower == '.' || lower == '_';
    if (plain) {
      result += lower;
    } else if (!result.empty() && result.back() != '-') {
      result += '-';
    }
  }
  while (!result.empty() && (result.back() == '-' || result.back() == '.')) result.pop_back();
  result.erase(0, result.find_first_not_of(".-"));
  return result;
}

}  // namespace qtrace::experiments
