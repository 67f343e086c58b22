#include "experiments/config/published.h"

namespace qtrace::experiments {

const double* PublishedTimes::find(const std::string& configuration) const {
  for (const auto& [name, ms] : by_configuration) {
    if (name == configuration) return &ms;
  }
  return nullptr;
}

std::string KnobType<PublishedTimes>::describe(const KnobInfo&) {
  return "an object of configurations and positive numbers";
}

void KnobType<PublishedTimes>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                    PublishedTimes& times) {
  if (!json.is_object()) reject_value(path, json, describe(info));
  times.by_configuration.clear();
  for (const auto& [configuration, value] : json.items()) {
    double ms = 0;
    KnobType<double>::read(value, info, path + '.' + configuration, ms);
    check(ms > 0, "key '{}.{}' is {} but must be a positive number", path, configuration, ms);
    times.by_configuration.emplace_back(configuration, ms);
  }
}

Json KnobType<PublishedTimes>::schema(const KnobInfo&) {
  return {{"type", "object"}, {"additionalProperties", {{"type", "number"}, {"exclusiveMinimum", 0}}}};
}

Json KnobType<PublishedTimes>::write(const PublishedTimes& times) {
  Json json = Json::object();
  for (const auto& [configuration, ms] : times.by_configuration) json[configuration] = ms;
  return json;
}

}  // namespace qtrace::experiments
