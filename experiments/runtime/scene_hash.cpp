#include "experiments/runtime/scene_hash.h"

#include "experiments/files/hash.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace qtrace::experiments {
namespace {

// All that triangles have had from the start: the members before `attributes`.
void add_triangle(Hasher& hasher, const Triangle& triangle) {
  constexpr std::size_t kBytes = offsetof(Triangle, attributes);
  static_assert(kBytes == 26 * 4, "padding would make equal triangles hash differently");
  std::array<std::byte, kBytes> bytes;
  std::memcpy(bytes.data(), &triangle, kBytes);
  hasher.add(bytes);
}

void add_texture(Hasher& hasher, const Texture& texture) {
  hasher.add(texture.image);
  hasher.add(texture.wrap_u);
  hasher.add(texture.wrap_v);
  hasher.add(texture.is_nearest);
  hasher.add(texture.uv_set);
  hasher.add(texture.image_from_uv);
}

void add_later_members(Hasher& hasher, const Material& material) {
  const Material implied;
  const auto add = [&](std::string_view name, const auto& value, const auto& otherwise) {
    hasher.add_later(name, value, otherwise);
  };
  add("ior", material.ior, implied.ior);
  add("opacity", material.opacity, implied.opacity);
  add("alpha_mode", material.alpha_mode, implied.alpha_mode);
  add("alpha_cutoff", material.alpha_cutoff, implied.alpha_cutoff);
  add("transmission", material.transmission, implied.transmission);
  add("is_thin", material.is_thin, implied.is_thin);
  add("attenuation_color", material.attenuation_color, implied.attenuation_color);
  add("attenuation_distance", material.attenuation_distance, implied.attenuation_distance);
  add("clearcoat", material.clearcoat, implied.clearcoat);
  add("clearcoat_roughness", material.clearcoat_roughness, implied.clearcoat_roughness);
  add("is_unlit", material.is_unlit, implied.is_unlit);
  add("normal_scale", material.normal_scale, implied.normal_scale);
  add("clearcoat_normal_scale", material.clearcoat_normal_scale, implied.clearcoat_normal_scale);
  for (std::size_t slot = 0; slot < material.textures.size(); ++slot) {
    if (!material.textures[slot]) continue;
    hasher.add(slot);
    add_texture(hasher, *material.textures[slot]);
  }
}

// What materials have had from the start; further members are added by Hasher::add_later().
void add_material(Hasher& hasher, const Material& material) {
  hasher.add(material.base_color);
  hasher.add(material.metallic);
  hasher.add(material.roughness);
  hasher.add(material.specular);
  hasher.add(material.specular_color);
  hasher.add(material.emission);
  hasher.add(material.double_sided);
  add_later_members(hasher, material);
}

void add_image(Hasher& hasher, const TextureImage& image) {
  hasher.add(image.width);
  hasher.add(image.height);
  hasher.add_all(image.texels);
}

void add_attributes(Hasher& hasher, const Scene& scene) {
  static_assert(sizeof(TriangleAttributes) == 30 * 4, "padding would make equal attributes hash differently");
  hasher.add_all(scene.attributes);
  for (const Triangle& triangle : scene.triangles) hasher.add(triangle.attributes);
}

void add_light(Hasher& hasher, const PunctualLight& light) {
  hasher.add(light.kind);
  hasher.add(light.position);
  hasher.add(light.direction);
  hasher.add(light.intensity);
  hasher.add(light.range);
  hasher.add(light.inner_cone_angle);
  hasher.add(light.outer_cone_angle);
}

// What scenes had not from the start: it leaves no trace where there is none.
void add_later_parts(Hasher& hasher, const Scene& scene) {
  if (!scene.attributes.empty()) add_attributes(hasher, scene);
  hasher.add_later("images", scene.images.size(), std::size_t{0});
  for (const TextureImage& image : scene.images) add_image(hasher, image);
  hasher.add_later("lights", scene.lights.size(), std::size_t{0});
  for (const PunctualLight& light : scene.lights) add_light(hasher, light);
}

// Scenes have had one later than hashes: none leaves no trace.
void add_environment(Hasher& hasher, const EnvironmentMap& map) {
  static_assert(sizeof(glm::vec3) == 3 * 4, "padding would make equal texels hash differently");
  for (const char c : std::string_view("environment")) hasher.add(c);
  hasher.add(map.width);
  hasher.add(map.height);
  hasher.add(map.rotation);
  for (const glm::vec3& radiance : map.radiance) hasher.add(radiance);
}

}  // namespace

std::string scene_hash(const Scene& scene) {
  Hasher hasher;
  hasher.add(scene.triangles.size());
  for (const Triangle& triangle : scene.triangles) add_triangle(hasher, triangle);
  hasher.add(scene.materials.size());
  for (const Material& material : scene.materials) add_material(hasher, material);
  hasher.add(scene.objects.size());
  for (const Object& object : scene.objects) {
    hasher.add(object.first_triangle);
    hasher.add(object.triangle_count);
    hasher.add(object.has_uv);
  }
  hasher.add(scene.camera.world_from_camera);
  hasher.add(scene.camera.vertical_fov);
  hasher.add_later("film_height", scene.camera.film_height, 0.0F);
  add_later_parts(hasher, scene);
  if (scene.environment) add_environment(hasher, *scene.environment);
  return hasher.digest();
}

}  // namespace qtrace::experiments
