#include "experiments/config/view_knobs.h"

#include "experiments/config/json_knobs.h"

namespace qtrace {

// The members of an object that places a camera.
template <class Visitor>
void visit_knobs(Visitor& visit, CameraPlace& place) {
  constexpr double kMost = 1e18;  // squares of such distances fit a float
  visit(KnobInfo{"position", "", "", -kMost, kMost}, place.position);
  visit(KnobInfo{"target", "", "", -kMost, kMost}, place.target);
  visit(KnobInfo{"up", "", "", -kMost, kMost}, place.up);
  visit(KnobInfo{"fov", "", "", 0.001, 179.9}, place.vertical_fov);
}

}  // namespace qtrace

namespace qtrace::experiments {
namespace {

constexpr const char* kFit = "fit";

bool is_index(const Json& json) {
  return json.is_number_unsigned() && json.get<std::uint64_t>() <= 1'000'000'000U;
}

void read_place(const Json& json, const KnobInfo& info, const std::string& path, CameraPlace& place) {
  for (const char* needed : {"position", "target"}) {
    if (!json.contains(needed))
      reject_value(path, json, KnobType<CameraChoice>::describe(info),
                   fmt::format("; '{}' is missing", needed));
  }
  place = {};
  read_knobs(json, place, path);
}

}  // namespace

std::string KnobType<NameOrIndex>::describe(const KnobInfo&) { return "a name or an index from 0"; }

void KnobType<NameOrIndex>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                 NameOrIndex& value) {
  value = {};
  if (json.is_string()) {
    value.name = json.get<std::string>();
  } else if (is_index(json)) {
    value.index = json.get<std::size_t>();
  } else {
    reject_value(path, json, describe(info));
  }
}

Json KnobType<NameOrIndex>::write(const NameOrIndex& value) {
  return value.index ? Json(*value.index) : Json(value.name);
}

Json KnobType<NameOrIndex>::schema(const KnobInfo&) {
  return {{"anyOf", {{{"type", "string"}}, {{"type", "integer"}, {"minimum", 0}}}}};
}

std::string KnobType<CameraChoice>::describe(const KnobInfo&) {
  return "\"fit\", a camera's name or index from 0, or {\"position\": [x, y, z], \"target\": [x, y, z], "
         "\"up\": [x, y, z], "
         "\"fov\": degrees}";
}

void KnobType<CameraChoice>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                  CameraChoice& choice) {
  choice = {};
  if (json == kFit) {
    choice.kind = CameraChoice::Kind::fit;
  } else if (json.is_object()) {
    choice.kind = CameraChoice::Kind::placed;
    read_place(json, info, path, choice.place);
  } else if (json.is_string() || is_index(json)) {
    KnobType<NameOrIndex>::read(json, info, path, choice.of_file);
  } else {
    reject_value(path, json, describe(info));
  }
}

Json KnobType<CameraChoice>::write(const CameraChoice& choice) {
  if (choice.kind == CameraChoice::Kind::fit) return kFit;
  if (choice.kind == CameraChoice::Kind::placed) return write_knobs(choice.place);
  return KnobType<NameOrIndex>::write(choice.of_file);
}

Json KnobType<CameraChoice>::schema(const KnobInfo& info) {
  const Json vector = KnobType<std::array<double, 3>>::schema({});
  const Json place{{"type", "object"},
                   {"properties",
                    {{"position", vector},
                     {"target", vector},
                     {"up", vector},
                     {"fov", number_schema("number", 0.001, 179.9)}}},
                   {"required", {"position", "target"}},
                   {"additionalProperties", false}};
  Json schema = KnobType<NameOrIndex>::schema(info);
  schema["anyOf"].push_back(place);
  return schema;
}

}  // namespace qtrace::experiments
