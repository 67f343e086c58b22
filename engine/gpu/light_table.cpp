#include "engine/gpu/light_table.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>
#include <map>

namespace qtrace::gpu {
namespace {

constexpr uint kWholeSlot = 0xffffffff;  // alias threshold of a light that fills its slot

double mean_radiance(const qtrace::Material& material) {
  return (double{material.emission.r} + material.emission.g + material.emission.b) / 3.0;
}

// Walker 1977 with Vose's 1991 construction: thresholds and aliases of a discrete distribution.
void build_aliases(std::vector<Light>& lights, const std::vector<double>& probability) {
  const std::size_t n = lights.size();
  std::vector<double> scaled(n);
  std::vector<std::size_t> small;
  std::vector<std::size_t> large;
  for (std::size_t i = 0; i < n; ++i) {
    scaled[i] = probability[i] * static_cast<double>(n);
    (scaled[i] < 1 ? small : large).push_back(i);
    lights[i].link.z = kWholeSlot;
    lights[i].link.x = static_cast<uint>(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::size_t s = small.back();
    const std::size_t l = large.back();
    small.pop_back();
    lights[s].link.z = static_cast<uint>(scaled[s] * kWholeSlot);
    lights[s].link.x = static_cast<uint>(l);
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
}

struct Emitter {
  std::size_t triangle;
  double area;
  double power;
};

std::vector<Emitter> find_emitters(const Scene& scene) {
  std::vector<Emitter> emitters;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle& t = scene.triangles[i];
    const qtrace::Material& material = scene.materials[t.material];
    const double radiance = mean_radiance(material);
    const double area = area_of(t);
    if (radiance > 0 && area > 0)
      emitters.push_back({i, area, radiance * area * (material.double_sided ? 2 : 1)});
  }
  return emitters;
}

Light make_light(const Scene& scene, const Emitter& emitter, double probability, double object_probability) {
  const Triangle& t = scene.triangles[emitter.triangle];
  const qtrace::Material& material = scene.materials[t.material];
  Light light{};
  light.vertex = vec4(t.position[0], 0);
  light.edge1 = vec4(t.position[1] - t.position[0], ray_offset(t));
  light.edge2 = vec4(t.position[2] - t.position[0], static_cast<float>(probability / emitter.area));
  light.normal =
      vec4(glm::vec3(glm::normalize(area_vector(t.position))), static_cast<float>(object_probability));
  light.radiance = vec4(material.emission, material.double_sided ? 1.0F : 0.0F);
  light.link.y = t.object;
  return light;
}

}  // namespace

float ray_offset(const Triangle& triangle) {
  const auto& p = triangle.position;
  const glm::vec3 reach = glm::max(glm::abs(p[0]), glm::max(glm::abs(p[1]), glm::abs(p[2])));
  return OFFSET_FRACTION * std::max({reach.x, reach.y, reach.z});
}

LightTable build_light_table(const Scene& scene) {
  LightTable table;
  table.light_of.assign(scene.triangles.size(), NO_LIGHT);
  const std::vector<Emitter> emitters = find_emitters(scene);
  double total = 0;
  std::map<uint, double> object_power;
  for (const Emitter& e : emitters) {
    total += e.power;
    object_power[scene.triangles[e.triangle].object] += e.power;
  }
  std::vector<double> probability;
  for (const Emitter& e : emitters) {
    probability.push_back(e.power / total);
    table.light_of[e.triangle] = static_cast<uint>(table.lights.size());
    table.lights.push_back(
        make_light(scene, e, probability.back(), object_power[scene.triangles[e.triangle].object] / total));
  }
  build_aliases(table.lights, probability);
  return table;
}

}  // namespace qtrace::gpu
