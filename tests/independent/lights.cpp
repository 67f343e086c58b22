#include "tests/independent/lights.h"

#include "tests/independent/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::independent {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};  // no light

glm::dvec3 place_at(const Triangle& t, double u, double v) {
  return (1 - u - v) * glm::dvec3(t.position[0]) + u * glm::dvec3(t.position[1]) +
         v * glm::dvec3(t.position[2]);
}

double sum_of(const glm::dvec3& v) { return v.x + v.y + v.z; }

// Roughly, where a texture varies: as the mean of a lattice of points. Never zero where it may emit.
double mean_emission(const Scene& scene, std::uint32_t triangle) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  const double most = sum_of(glm::dvec3(material.emission));
  if (!material.texture(TextureSlot::emission)) return most;
  constexpr int kLattice = 8;
  constexpr double kLeast = 0.005;
  double sum = 0;
  int points = 0;
  for (int i = 0; i < kLattice; ++i) {
    for (int j = 0; i + j < kLattice; ++j, ++points) {
      sum += sum_of(emission_at(scene, {0, triangle, (i + 1 / 3.0) / kLattice, (j + 1 / 3.0) / kLattice}));
    }
  }
  return std::max(sum / points, kLeast * most);
}

// KHR_lights_punctual: its reference code for the cone.
double spot_attenuation(const PunctualLight& light, const glm::dvec3& to_light) {
  const double inner = std::cos(double{light.inner_cone_angle}),
               outer = std::cos(double{light.outer_cone_angle});
  const double scale = 1 / std::max(0.001, inner - outer);
  const double cosine = -glm::dot(glm::dvec3(light.direction), to_light);
  const double angular = std::clamp((cosine - outer) * scale, 0.0, 1.0);
  return angular * angular;
}

}  // namespace

AreaLights::AreaLights(const Scene& scene) : scene_(scene) {
  double sum = 0;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    const double power = scene.materials[t.material].is_unlit ? 0 : area_of(t) * mean_emission(scene, i);
    of_triangle_.push_back(power > 0 ? lights_.size() : kNone);
    if (power == 0) continue;
    lights_.push_back({i, power, area_of(t), place_at(t, 1 / 3.0, 1 / 3.0)});
    power_up_to_.push_back(sum += power);
  }
}

bool AreaLights::are_many() const {
  constexpr std::size_t kMany = 500;
  return lights_.size() > kMany;
}

// Its power over the squared distance of its middle; its area keeps that finite.
double AreaLights::weight(const Light& light, const glm::dvec3& from) const {
  if (are_many()) return light.power;
  const glm::dvec3 way = light.middle - from;
  return light.power / (glm::dot(way, way) + light.area);
}

double AreaLights::sum_of_weights(const glm::dvec3& from) const {
  if (are_many()) return power_up_to_.back();
  double sum = 0;
  for (const Light& light : lights_) sum += weight(light, from);
  return sum;
}

const AreaLights::Light& AreaLights::at(const glm::dvec3& from, double sum) const {
  if (are_many()) {
    const auto found = std::upper_bound(power_up_to_.begin(), power_up_to_.end() - 1, sum);
    return lights_[static_cast<std::size_t>(found - power_up_to_.begin())];
  }
  for (const Light& light : lights_) {
    const double w = weight(light, from);
    if (sum < w) return light;
    sum -= w;
  }
  return lights_.back();
}

AreaLights::Sample AreaLights::sample(const glm::dvec3& from, Random& random) const {
  const double sum = sum_of_weights(from);
  const Light& light = at(from, random() * sum);
  const double root = std::sqrt(random()), part = random();
  const Hit place{0, light.triangle, root * (1 - part), root * part};
  return {place, place_at(scene_.triangles[light.triangle], place.u, place.v),
          weight(light, from) / sum / light.area};
}

double AreaLights::density(const glm::dvec3& from, std::uint32_t triangle) const {
  if (of_triangle_[triangle] == kNone) return 0;
  const Light& light = lights_[of_triangle_[triangle]];
  return weight(light, from) / sum_of_weights(from) / light.area;
}

Arriving arriving(const PunctualLight& light, const glm::dvec3& at) {
  const glm::dvec3 intensity(light.intensity);
  if (light.kind == PunctualLight::Kind::directional) {
    return {-glm::normalize(glm::dvec3(light.direction)), std::numeric_limits<double>::infinity(), intensity};
  }
  const glm::dvec3 way = glm::dvec3(light.position) - at;
  const double distance = glm::length(way);
  Arriving result{way / distance, distance, intensity / (distance * distance)};
  // KHR_lights_punctual: the window of the range.
  result.irradiance *= std::clamp(1 - std::pow(distance / double{light.range}, 4), 0.0, 1.0);
  if (light.kind == PunctualLight::Kind::spot) result.irradiance *= spot_attenuation(light, result.to_light);
  return result;
}

}  // namespace qtrace::independent
