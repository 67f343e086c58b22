#include "experiments/config/environment_knob.h"

#include "experiments/config/json_knobs.h"

namespace qtrace::experiments {
namespace {

using Constant = KnobType<std::array<double, 3>>;

constexpr KnobInfo kFile{"file", "", ""};
constexpr KnobInfo kScale{"scale", "", "", 0, 1e8};
constexpr KnobInfo kRotation{"rotation", "", "", -360, 360};

}  // namespace

// The members of an object that names an image.
template <class Visitor>
void visit_knobs(Visitor& visit, EnvironmentImage& image) {
  visit(kFile, image.file);
  visit(kScale, image.scale);
  visit(kRotation, image.rotation);
}

std::string KnobType<RadianceScale>::describe(const KnobInfo& info) {
  return KnobType<double>::describe(info) + ", or " + Constant::describe(info);
}

void KnobType<RadianceScale>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                   RadianceScale& scale) {
  if (json.is_array() && json.size() == scale.rgb.size()) return Constant::read(json, info, path, scale.rgb);
  const bool fits = json.is_number() && json.get<double>() >= info.min && json.get<double>() <= info.max;
  if (!fits) reject_value(path, json, describe(info));
  scale.rgb.fill(json.get<double>());
}

Json KnobType<RadianceScale>::write(const RadianceScale& scale) {
  const bool is_grey = scale.rgb[0] == scale.rgb[1] && scale.rgb[1] == scale.rgb[2];
  return is_grey ? Json(scale.rgb[0]) : Constant::write(scale.rgb);
}

Json KnobType<RadianceScale>::schema(const KnobInfo& info) {
  return {{"anyOf", {KnobType<double>::schema(info), Constant::schema(info)}}};
}

std::string KnobType<EnvironmentKnob>::describe(const KnobInfo& info) {
  return Constant::describe(info) + ", or {\"file\": path of an .exr or .hdr image in latitude and " +
         "longitude, \"scale\": number or [r, g, b], \"rotation\": degrees about +y}";
}

void KnobType<EnvironmentKnob>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                     EnvironmentKnob& knob) {
  if (!json.is_object()) {
    if (!json.is_array() || json.size() != knob.constant.size()) reject_value(path, json, describe(info));
    Constant::read(json, info, path, knob.constant);
    knob.image.reset();
    return;
  }
  EnvironmentImage image;
  read_knobs(json, image, path);
  if (image.file.empty()) reject_value(path, json, describe(info), "; 'file' is missing");
  knob.constant = {};
  knob.image = std::move(image);
}

Json KnobType<EnvironmentKnob>::write(const EnvironmentKnob& knob) {
  return knob.image ? environment_json(*knob.image) : Constant::write(knob.constant);
}

Json KnobType<EnvironmentKnob>::schema(const KnobInfo& info) {
  Json file = KnobType<std::string>::schema(kFile);
  file["minLength"] = 1;
  const Json image{{"type", "object"},
                   {"properties",
                    {{"file", file},
                     {"scale", KnobType<RadianceScale>::schema(kScale)},
                     {"rotation", KnobType<double>::schema(kRotation)}}},
                   {"required", {"file"}},
                   {"additionalProperties", false}};
  return {{"anyOf", {Constant::schema(info), image}}};
}

Json environment_json(const EnvironmentImage& image) { return write_knobs(image); }

}  // namespace qtrace::experiments
