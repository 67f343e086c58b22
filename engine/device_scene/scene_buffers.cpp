#include "engine/device_scene/scene_buffers.h"

#include "engine/core/check.h"
#include "engine/device_scene/light_table.h"

#include <glm/common.hpp>

#include <algorithm>
#include <bit>
#include <utility>

namespace qtrace::gpu {
namespace {

// Below this the GGX lobe is narrower than single precision resolves.
constexpr float kMinRoughness = 0.03F;
// Reflectance of a dielectric of index of refraction 1.5 at normal incidence (glTF 2.0, Appendix B).
constexpr float kDielectricF0 = 0.04F;

float as_float(uint bits) { return std::bit_cast<float>(bits); }

// Stands for kNoTriangle: all of its corners are one point, which no ray hits.
constexpr TriangleShape kPoint{};

std::vector<TriangleShape> pack_shapes(const Scene& scene, const Bvh& bvh) {
  std::vector<TriangleShape> shapes;
  shapes.reserve(bvh.order.size());
  for (const uint i : bvh.order) {
    if (i == kNoTriangle) {
      shapes.push_back(kPoint);
      continue;
    }
    const auto& p = scene.triangles[i].position;
    shapes.push_back({vec4(p[0], 0), vec4(p[1], 0), vec4(p[2], 0)});
  }
  return shapes;
}

std::vector<TriangleShade> pack_shades(const Scene& scene, const Bvh& bvh, const LightTable& lights) {
  std::vector<TriangleShade> shades;
  shades.reserve(bvh.order.size());
  for (const uint i : bvh.order) {
    if (i == kNoTriangle) {
      shades.push_back({});
      continue;
    }
    const Triangle& t = scene.triangles[i];
    shades.push_back({vec4(t.normal[0], as_float(t.material)), vec4(t.normal[1], as_float(t.object)),
                      vec4(t.normal[2], as_float(lights.triangle_of[i]))});
  }
  return shades;
}

bool has_specular_lobe(const qtrace::Material& m) { return m.metallic > 0 || m.specular > 0; }

gpu::Material pack_material(const qtrace::Material& m) {
  const float roughness = std::max(m.roughness, kMinRoughness);
  // KHR_materials_specular: F0 = min(0.04 * colour, 1) * strength, F90 = strength.
  const glm::vec3 f0 = glm::min(kDielectricF0 * m.specular_color, glm::vec3(1.0F)) * m.specular;
  return {vec4(m.base_color, m.metallic), vec4(m.emission, m.double_sided ? 1.0F : 0.0F),
          vec4(f0, m.specular), vec4(roughness * roughness, 0, 0, 0)};
}

std::vector<gpu::Material> pack_materials(const Scene& scene) {
  std::vector<gpu::Material> materials;
  for (const qtrace::Material& m : scene.materials) materials.push_back(pack_material(m));
  return materials;
}

SceneFeatures features_of(const Scene& scene, const LightTable& lights) {
  return {std::ranges::any_of(scene.materials, has_specular_lobe), static_cast<uint>(lights.lights.size()),
          lights.brightest};
}

}  // namespace

SceneFeatures find_features(const Scene& scene) {
  return features_of(scene, build_light_table(scene, LightChoice::power));
}

SceneBuffers::SceneBuffers(const Scene& scene, const Bvh& bvh, LightChoice lights)
    : SceneBuffers(scene, bvh, build_light_table(scene, lights)) {}

SceneBuffers::SceneBuffers(const Scene& scene, const Bvh& bvh, const LightTable& lights)
    : features_(features_of(scene, lights)),
      nodes_(bvh, glm::vec3(scene.camera.world_from_camera[3])),
      shapes_("triangle shapes", pack_shapes(scene, bvh), only_fetched(Texels::float4)),
      shades_("triangle normals", pack_shades(scene, bvh, lights), only_fetched(Texels::float4)),
      materials_("materials", pack_materials(scene), only_fetched(Texels::float4)),
      light_triangles_("light triangles", lights.triangles, only_fetched(Texels::float4)),
      lights_("lights", lights.lights, only_fetched(Texels::float4)) {
  for (const qtrace::Material& m : scene.materials) {
    if (!has_specular_lobe(m) || m.roughness >= kMinRoughness) continue;
    warnings_.push_back(fmt::format(
        "material '{}' has roughness {}, which is rendered as {}: perfect mirrors are not modelled", m.name,
        m.roughness, kMinRoughness));
  }
}

void SceneBuffers::bind() const {
  nodes_.bind();
  shapes_.bind_fetched(UNIT_SHAPES);
  shades_.bind_fetched(UNIT_SHADES);
  materials_.bind_fetched(UNIT_MATERIALS);
  light_triangles_.bind_fetched(UNIT_LIGHT_TRIANGLES);
  lights_.bind_fetched(UNIT_LIGHTS);
}

std::size_t SceneBuffers::bytes() const {
  return nodes_.bytes() + shapes_.bytes() + shades_.bytes() + materials_.bytes() + light_triangles_.bytes() +
         lights_.bytes();
}

}  // namespace qtrace::gpu
