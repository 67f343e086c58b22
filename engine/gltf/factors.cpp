#include "engine/gltf/factors.h"

#include <algorithm>

namespace qtrace::gltf {

float Factors::scalar(std::string_view property, double value, float max) const {
  constexpr double kRounding = 1e-5;  // so far beyond the limits, it is clear what was meant
  const auto most = static_cast<double>(max);
  source_.check(value >= -kRounding && value <= most + kRounding, "{}: {} is {}; {} would be right",
                material_, property, value, max < kNoLimit ? fmt::format("0 to {}", max) : "0 or more");
  const double meant = std::clamp(value, 0.0, most);
  if (meant != value) source_.warn("{}: {} is {}; it is read as {}", material_, property, value, meant);
  return static_cast<float>(meant);
}

glm::vec3 Factors::rgb(std::string_view property, const std::vector<double>& value, float max) const {
  return {scalar(property, value[0], max), scalar(property, value[1], max), scalar(property, value[2], max)};
}

const tinygltf::Value* Factors::find(const std::string& extension, const std::string& property) const {
  const auto found = file_.extensions.find(extension);
  const bool is_there = found != file_.extensions.end() && found->second.Has(property);
  return is_there ? &found->second.Get(property) : nullptr;
}

double Factors::number(const std::string& extension, const std::string& property, double otherwise) const {
  const tinygltf::Value* value = find(extension, property);
  return value == nullptr ? otherwise : value->GetNumberAsDouble();
}

float Factors::scalar_of(const std::string& extension, const std::string& property, double otherwise,
                         float max) const {
  return scalar(property, number(extension, property, otherwise), max);
}

glm::vec3 Factors::rgb_of(const std::string& extension, const std::string& property, float max) const {
  const tinygltf::Value* value = find(extension, property);
  if (value == nullptr) return glm::vec3(1);
  return rgb(property,
             {value->Get(0).GetNumberAsDouble(), value->Get(1).GetNumberAsDouble(),
              value->Get(2).GetNumberAsDouble()},
             max);
}

}  // namespace qtrace::gltf
