#include "experiments/config/published.h"

namespace qtrace::experiments {

const double* PublishedTimes::find(const std::string& cell) const {
  for (const auto& [name, ms] : by_cell) {
    if (name == cell) return &ms;
  }
  return nullptr;
}

std::string KnobType<PublishedTimes>::describe(const KnobInfo&) {
  return "an object of cells and positive numbers";
}

void KnobType<PublishedTimes>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                    PublishedTimes& times) {
  if (!json.is_object()) reject_value(path, json, describe(info));
  times.by_cell.clear();
  for (const auto& [cell, value] : json.items()) {
    double ms = 0;
    KnobType<double>::read(value, info, path + '.' + cell, ms);
    check(ms > 0, "key '{}.{}' is {} but must be a positive number", path, cell, ms);
    times.by_cell.emplace_back(cell, ms);
  }
}

Json KnobType<PublishedTimes>::schema(const KnobInfo&) {
  return {{"type", "object"}, {"additionalProperties", {{"type", "number"}, {"exclusiveMinimum", 0}}}};
}

Json KnobType<PublishedTimes>::write(const PublishedTimes& times) {
  Json json = Json::object();
  for (const auto& [cell, ms] : times.by_cell) json[cell] = ms;
  return json;
}

}  // namespace qtrace::experiments
