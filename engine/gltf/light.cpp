#include "engine/gltf/light.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::gltf {
namespace {

// As of a surface's emission: a film sums squares of it.
constexpr double kMostIntensity = 1e12;

glm::vec3 intensity_of(Source& source, const tinygltf::Light& file, const std::string& place) {
  const std::vector<double> color = file.color.empty() ? std::vector<double>{1, 1, 1} : file.color;
  source.check(*std::ranges::min_element(color) >= 0, "{}: color is {} {} {}; 0 or more would be right",
               place, color[0], color[1], color[2]);
  source.check(file.intensity >= 0, "{}: intensity is {}; 0 or more would be right", place, file.intensity);
  const double most = *std::ranges::max_element(color);
  source.check(most * file.intensity <= kMostIntensity,
               "{}: shines with {:g}, color times intensity; up to {:g} would be right", place,
               most * file.intensity, kMostIntensity);
  if (most > 1) {
    source.warn("{}: color is {} {} {}, where KHR_lights_punctual ends at 1; it is read as it stands", place,
                color[0], color[1], color[2]);
  }
  return file.intensity * glm::dvec3(color[0], color[1], color[2]);
}

void read_cone(Source& source, const tinygltf::SpotLight& file, const std::string& place,
               PunctualLight& light) {
  constexpr double kRounding = 1e-6;  // of a right angle in single precision
  constexpr double kSharp = 0.999;
  const double inner = file.innerConeAngle, outer = file.outerConeAngle;
  source.check(outer > 0 && outer <= glm::half_pi<double>() + kRounding,
               "{}: outerConeAngle is {}; above 0 and up to pi / 2 would be right", place, outer);
  source.check(inner >= 0 && inner <= outer,
               "{}: innerConeAngle is {}; 0 or more, and less than outerConeAngle, {}, would be right", place,
               inner, outer);
  light.outer_cone_angle = static_cast<float>(outer);
  light.inner_cone_angle = static_cast<float>(inner);
  if (inner < outer) return;
  // What exporters write of a spot with a sharp edge.
  light.inner_cone_angle = static_cast<float>(kSharp * outer);
  source.warn(
      "{}: innerConeAngle is outerConeAngle, where KHR_lights_punctual has it less; it is read as {:.4g}",
      place, light.inner_cone_angle);
}

PunctualLight read_light(Source& source, std::size_t index) {
  const tinygltf::Light& file = source.model.lights[index];
  const std::string place = label("light", index, file.name);
  PunctualLight light;
  light.name = file.name.empty() ? place : file.name;
  light.intensity = intensity_of(source, file, place);
  if (file.type == "directional") light.kind = PunctualLight::Kind::directional;
  if (file.type == "spot") {
    light.kind = PunctualLight::Kind::spot;
    read_cone(source, file.spot, place, light);
  }
  if (file.range > 0 && light.kind != PunctualLight::Kind::directional) {
    light.range = static_cast<float>(file.range);
  }
  return light;
}

void put(const Source& source, const PlacedNode& node, PunctualLight& light) {
  if (light.kind != PunctualLight::Kind::directional) light.position = glm::vec3(node.to_world[3]);
  if (light.kind == PunctualLight::Kind::point) return;
  const glm::dvec3 direction = -glm::dvec3(node.to_world[2]);
  const double length = glm::length(direction);
  source.check(length > 0, "{}: its light is squeezed flat; a scale other than 0 would be right",
               node_label(source, node.index));
  light.direction = direction / length;
}

}  // namespace

std::vector<PunctualLight> read_lights(Source& source, const std::vector<PlacedNode>& nodes) {
  std::vector<PunctualLight> files;
  for (std::size_t i = 0; i < source.model.lights.size(); ++i) files.push_back(read_light(source, i));
  std::vector<PunctualLight> lights;
  for (const PlacedNode& node : nodes) {
    if (node.light < 0) continue;
    PunctualLight light = files.at(static_cast<std::size_t>(node.light));
    put(source, node, light);
    if (light.intensity != glm::vec3(0)) lights.push_back(std::move(light));
  }
  return lights;
}

}  // namespace qtrace::gltf
