#include "engine/device_scene/scene_features.h"

#include <algorithm>
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

bool has_color(const TriangleAttributes& attributes) {
  return std::ranges::any_of(attributes.color, [](const glm::vec4& c) { return c != glm::vec4(1); });
}

}  // namespace

bool has_specular_lobe(const qtrace::Material& m) { return m.metallic > 0 || m.specular > 0; }

SceneFeatures find_features(const Scene& scene) {
  return find_features(scene, build_light_table(scene, LightChoice::power));
}

SceneFeatures find_features(const Scene& scene, const LightTable& lights) {
  SceneFeatures features;
  features.specular = std::ranges::any_of(scene.materials, has_specular_lobe);
  features.textures = texture_bits(scene);
  features.tangents =
      has(features.textures, TextureSlot::normal) || has(features.textures, TextureSlot::clearcoat_normal);
  features.colors = std::ranges::any_of(scene.attributes, has_color);
  features.alpha = std::ranges::any_of(
      scene.materials, [](const qtrace::Material& m) { return m.alpha_mode != AlphaMode::opaque; });
  features.punctual =
      std::ranges::any_of(lights.lights, [](const Light& light) { return light.choice.z >= LIGHT_POINT; });
  if (!lights.sky.empty()) {
    features.sky = {scene.environment->width, scene.environment->height};
    features.sky_turn = scene.environment->rotation / (2 * std::numbers::pi_v<float>);
  }
  features.reach = static_cast<float>(kReach * scene_radius(scene));
  features.lights = static_cast<uint>(lights.lights.size());
  features.brightest = lights.brightest;
  return features;
}

}  // namespace qtrace::gpu
