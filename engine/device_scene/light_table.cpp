#include "engine/device_scene/light_table.h"

#include "engine/accel/bounds.h"
#include "engine/device_scene/alias_table.h"
#include "engine/device_scene/emitters.h"
#include "engine/device_scene/light_groups.h"
#include "engine/device_scene/punctual_lights.h"
#include "engine/device_scene/sky_table.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace qtrace::gpu {
namespace {

double power_of_lamp(const Scene& scene, const Emitters& emitters, std::uint32_t triangle) {
  const Triangle& t = scene.triangles[triangle];
  return emitters.mean_radiance(triangle) * area_of(t) * (scene.materials[t.material].double_sided ? 2 : 1);
}

std::vector<std::uint32_t> find_emitters(const Scene& scene, const Emitters& emitters) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    if (emitters.emits(i) && area_of(scene.triangles[i]) > 0) found.push_back(i);
  }
  return found;
}

// `probability`: of the triangle within its light.
LightTriangle make_triangle(const Scene& scene, std::uint32_t index, double probability) {
  const Triangle& t = scene.triangles[index];
  const qtrace::Material& material = scene.materials[t.material];
  LightTriangle triangle{};
  triangle.vertex = vec4(t.position[0], 0);
  triangle.edge1 = vec4(t.position[1] - t.position[0], ray_offset(t));
  triangle.edge2 = vec4(t.position[2] - t.position[0], static_cast<float>(probability / area_of(t)));
  triangle.normal = vec4(glm::vec3(glm::normalize(area_vector(t.position))), 0);
  triangle.radiance = vec4(material.emission, material.double_sided ? EMITS_BOTH : EMITS_FRONT);
  return triangle;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

// Where a light is and faces; its radiance is not yet in units of the brightest.
Light make_light(const Scene& scene, const std::vector<std::uint32_t>& triangles, double power) {
  glm::dvec3 centre(0);
  glm::dvec3 axis(0);
  double area = 0;
  bool both = false;
  for (const std::uint32_t i : triangles) {
    const Triangle& t = scene.triangles[i];
    const double part = area_of(t);
    centre += part / 3 * (glm::dvec3(t.position[0]) + glm::dvec3(t.position[1]) + glm::dvec3(t.position[2]));
    axis += part * glm::normalize(area_vector(t.position));
    area += part;
    both = both || scene.materials[t.material].double_sided;
  }
  Light light{};
  light.centre = vec4(glm::vec3(centre / area), static_cast<float>(area));
  // What shines to all sides has no axis.
  light.axis = vec4(both ? glm::vec3(0) : glm::vec3(axis / area), static_cast<float>(power / area));
  return light;
}

// Appends a light of these triangles; its own choice is left open. Returns its power.
double add_light(LightTable& table, const Scene& scene, const Emitters& emitters,
                 const std::vector<std::uint32_t>& triangles) {
  std::vector<double> powers;
  for (const std::uint32_t i : triangles) powers.push_back(power_of_lamp(scene, emitters, i));
  const double power = sum_of(powers);
  const auto first = static_cast<uint>(table.triangles.size());
  const std::vector<AliasSlot> slots = build_aliases(powers);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    LightTriangle triangle = make_triangle(scene, triangles[i], powers[i] / power);
    triangle.link =
        uvec4(first + slots[i].alias, static_cast<uint>(table.lights.size()), slots[i].threshold, 0);
    table.triangle_of[triangles[i]] = static_cast<uint>(table.triangles.size());
    table.triangles.push_back(triangle);
    table.brightest = std::max(table.brightest, static_cast<float>(emitters.mean_radiance(triangles[i])));
  }
  Light light = make_light(scene, triangles, power);
  light.link = uvec4(0, first, 0, static_cast<uint>(triangles.size()));
  table.lights.push_back(light);
  return power;
}

SceneSphere scene_sphere(const Scene& scene) {
  Bounds bounds;
  for (const Triangle& t : scene.triangles) bounds.add(bounds_of(t));
  for (const PunctualLight& light : scene.lights) {
    if (light.kind != PunctualLight::Kind::directional) bounds.add(light.position);
  }
  if (bounds.lo.x > bounds.hi.x) return {};
  const glm::dvec3 lo(bounds.lo), hi(bounds.hi);
  return {0.5 * (lo + hi), 0.5 * glm::length(hi - lo)};
}

void add_lights_without_surface(LightTable& table, const Scene& scene, std::vector<double>& powers) {
  const double radius = table.sphere.radius;
  const auto add = [&](const Light& light, double power, double radiance) {
    table.lights.push_back(light);
    powers.push_back(power);
    table.brightest = std::max(table.brightest, static_cast<float>(radiance));
  };
  for (const PunctualLight& light : scene.lights) {
    if (light.intensity == glm::vec3(0)) continue;
    add(pack_punctual(light), power_of(light, radius), typical_radiance(light, radius));
  }
  if (!scene.environment) return;
  const double radiance = mean_radiance(*scene.environment);
  if (radiance <= 0) return;
  table.has_sky = true;
  Light light{};
  light.choice.z = LIGHT_SKY;
  light.axis.w = static_cast<float>(radiance);
  add(light, power_of_environment(radiance, radius), radiance);
}

void set_choices(LightTable& table, LightChoice choice, const std::vector<double>& powers) {
  const double total = sum_of(powers);
  table.power = total;
  const std::vector<double> chances =
      choice == LightChoice::uniform ? std::vector<double>(powers.size(), 1.0) : powers;
  const double all = sum_of(chances);
  const std::vector<AliasSlot> slots = build_aliases(chances);
  for (std::size_t i = 0; i < table.lights.size(); ++i) {
    Light& light = table.lights[i];
    light.choice.x = static_cast<float>(chances[i] / all);
    light.choice.y = static_cast<float>(powers[i] / total);
    light.link.x = slots[i].alias;
    light.link.z = slots[i].threshold;
    light.axis.w /= table.brightest;
  }
}

}  // namespace

double power_of_environment(double mean_radiance, double scene_radius) {
  return 4 * mean_radiance * scene_radius * scene_radius;
}

float ray_offset(const Triangle& triangle) {
  const auto& p = triangle.position;
  const glm::vec3 reach = glm::max(glm::abs(p[0]), glm::max(glm::abs(p[1]), glm::abs(p[2])));
  return OFFSET_FRACTION * std::max({reach.x, reach.y, reach.z});
}

LightTable build_light_table(const Scene& scene, LightChoice choice) {
  LightTable table;
  table.triangle_of.assign(scene.triangles.size(), NO_LIGHT);
  const Emitters emitters(scene);
  std::vector<double> powers;
  for (const auto& triangles : connected_groups(scene, find_emitters(scene, emitters))) {
    powers.push_back(add_light(table, scene, emitters, triangles));
  }
  table.sphere = scene_sphere(scene);
  add_lights_without_surface(table, scene, powers);
  set_choices(table, choice, powers);
  return table;
}

}  // namespace qtrace::gpu
