#include "engine/device_scene/scene_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace qtrace::gpu {
namespace {

// A ray from within the scene that is as long as two of its diameters ends outside.
constexpr double kReach = 4;

uint texture_bits(const Scene& scene) {
  uint bits = 0;
  for (const qtrace::Material& material : scene.materials) {
    for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
      if (material.textures[slot]) bits |= 1U << slot;
    }
  }
  return bits;
}

bool has(uint textures, TextureSlot slot) { return (textures >> static_cast<uint>(slot) & 1U) != 0; }

bool lets_pass(const qtrace::Material& m) {
  return !m.is_unlit && m.transmission > 0 && m.metallic < 1 && m.ior > 0;
}

bool absorbs(const qtrace::Material& m) {
  return lets_pass(m) && !m.is_thin && !std::isinf(m.attenuation_distance) &&
         m.attenuation_color != glm::vec3(1);
}

bool has_coat(const qtrace::Material& m) { return !m.is_unlit && m.clearcoat > 0; }

// Where a texture has the roughness, some point of it may be smooth.
bool may_mirror(const qtrace::Material& m) {
  const bool may_be_smooth = m.roughness < LEAST_ROUGHNESS || m.texture(TextureSlot::metallic_roughness);
  return has_specular_lobe(m) && (may_be_smooth || has_coat(m) || (lets_pass(m) && !m.is_thin && m.ior == 1));
}

bool has_color(const TriangleAttributes& attributes) {
  return std::ranges::any_of(attributes.color, [](const glm::vec4& c) { return c != glm::vec4(1); });
}

}  // namespace

bool has_specular_lobe(const qtrace::Material& m) {
  return !m.is_unlit && (m.metallic > 0 || m.specular > 0 || lets_pass(m) || has_coat(m));
}

SceneFeatures find_features(const Scene& scene) {
  return find_features(scene, build_light_table(scene, LightChoice::power));
}

SceneFeatures find_features(const Scene& scene, const LightTable& lights) {
  SceneFeatures features;
  const auto any = [&](auto has_it) { return std::ranges::any_of(scene.materials, has_it); };
  features.specular = any(has_specular_lobe);
  features.textures = texture_bits(scene);
  features.tangents =
      has(features.textures, TextureSlot::normal) || has(features.textures, TextureSlot::clearcoat_normal);
  features.colors = std::ranges::any_of(scene.attributes, has_color);
  features.transmission = any(lets_pass);
  features.absorption = any(absorbs);
  features.clearcoat = any(has_coat);
  features.delta = any(may_mirror);
  features.unlit = any([](const qtrace::Material& m) { return m.is_unlit; });
  features.alpha = any([](const qtrace::Material& m) { return m.alpha_mode != AlphaMode::opaque; });
  features.punctual =
      std::ranges::any_of(lights.lights, [](const Light& light) { return light.choice.z >= LIGHT_POINT; });
  if (lights.has_sky) {
    features.sky = {scene.environment->width, scene.environment->height};
    features.sky_turn = scene.environment->rotation / (2 * std::numbers::pi_v<float>);
  }
  features.reach = static_cast<float>(kReach * lights.sphere.radius);
  features.centre = glm::vec3(lights.sphere.centre);
  features.radius = static_cast<float>(lights.sphere.radius);
  features.power = static_cast<float>(lights.power);
  features.lights = static_cast<uint>(lights.lights.size());
  features.brightest = lights.brightest;
  return features;
}

}  // namespace qtrace::gpu
