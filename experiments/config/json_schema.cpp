#include "experiments/config/json_schema.h"

#include "experiments/config/experiment_config.h"

namespace qtrace::experiments {
namespace {

template <KnobGroup T>
Json group_schema(T group);

class KnobSchema {
 public:
  template <class T>
  void operator()(const KnobInfo& info, T& value) {
    Json schema;
    if constexpr (KnobGroup<T>) {
      schema = group_schema(value);
    } else {
      schema = KnobType<T>::schema(info);
      const Json usual = KnobType<T>::write(value);
      if (!usual.empty() && usual != "") schema["default"] = usual;
    }
    schema["description"] =
        info.unit.empty() ? std::string(info.help) : fmt::format("{} ({})", info.help, info.unit);
    properties[std::string(info.name)] = std::move(schema);
  }
  Json properties = Json::object();
};

template <KnobGroup T>
Json group_schema(T group) {
  KnobSchema schema;
  visit_knobs(schema, group);
  return {{"type", "object"}, {"properties", std::move(schema.properties)}, {"additionalProperties", false}};
}

// Where the schema of each key stands that a run's overrides may set: groups, their members and both dotted.
std::vector<std::pair<std::string, std::string>> places(const std::vector<std::string>& keys) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const std::string& key : keys) {
    std::string place = "#/properties/" + key;
    for (std::size_t dot = place.find('.'); dot != std::string::npos; dot = place.find('.')) {
      place.replace(dot, 1, "/properties/");
    }
    result.emplace_back(key, place);
  }
  return result;
}

std::vector<std::string> override_keys() {
  std::vector<std::string> keys = settable_keys(list_knobs(RunConfig{}));
  std::erase(keys, "name");  // belongs to the experiment as a whole
  return keys;
}

// {"key": [values]} or {"label": {"name": {overrides}}}, where the label may be a key as well.
Json axis_schema() {
  Json properties = Json::object();
  for (const auto& [key, place] : places(override_keys())) {
    const Json values{
        {"type", "array"}, {"items", {{"$ref", place}}}, {"minItems", 1}, {"uniqueItems", true}};
    properties[key] = {{"if", {{"type", "array"}}}, {"then", values}, {"else", {{"$ref", "#/$defs/groups"}}}};
  }
  return {{"type", "object"},
          {"minProperties", 1},
          {"maxProperties", 1},
          {"properties", properties},
          {"additionalProperties", {{"$ref", "#/$defs/groups"}}}};
}

Json groups_schema() {
  return {{"description", "named groups of overrides; the names label tables and curves"},
          {"type", "object"},
          {"minProperties", 1},
          {"additionalProperties", {{"$ref", "#/$defs/overrides"}}}};
}

Json overrides_schema() {
  Json properties = Json::object();
  for (const auto& [key, place] : places(override_keys())) properties[key] = {{"$ref", place}};
  return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

// Members of groups may be written with a dot at the top as well. As patterns they are accepted, but do not
// crowd an editor's suggestions.
Json dotted_patterns() {
  Json patterns = Json::object();
  for (const auto& [key, place] : places(settable_keys(list_knobs(ExperimentKeys{})))) {
    const std::size_t dot = key.find('.');
    if (dot == std::string::npos) continue;
    patterns["^" + key.substr(0, dot) + "\\." + key.substr(dot + 1) + "$"] = {{"$ref", place}};
  }
  return patterns;
}

}  // namespace

Json config_schema() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "qtrace experiment"}};
  schema.update(group_schema(ExperimentKeys{}));
  schema["properties"]["$schema"] = {{"type", "string"}, {"description", "of editors: where this schema is"}};
  schema["properties"]["name"].update({{"minLength", 1}, {"maxLength", 100}});
  schema["patternProperties"] = dotted_patterns();
  schema["required"] = {"name"};
  schema["$defs"] = {{"axis", axis_schema()}, {"groups", groups_schema()}, {"overrides", overrides_schema()}};
  return schema;
}

}  // namespace qtrace::experiments
