#include "experiments/runtime/scene_hash.h"

#include "experiments/files/hash.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace qtrace::experiments {
namespace {

// What materials have had from the start; further members are added by Hasher::add_later().
void add_material(Hasher& hasher, const Material& material) {
  hasher.add(material.base_color);
  hasher.add(material.metallic);
  hasher.add(material.roughness);
  hasher.add(material.specular);
  hasher.add(material.specular_color);
  hasher.add(material.emission);
  hasher.add(material.double_sided);
}

// All that triangles have had from the start: the members before `attributes`.
void add_triangle(Hasher& hasher, const Triangle& triangle) {
  constexpr std::size_t kBytes = offsetof(Triangle, attributes);
  static_assert(kBytes == 26 * 4, "padding would make equal triangles hash differently");
  std::array<std::byte, kBytes> bytes;
  std::memcpy(bytes.data(), &triangle, kBytes);
  hasher.add(bytes);
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
  if (scene.environment) add_environment(hasher, *scene.environment);
  return hasher.digest();
}

}  // namespace qtrace::experiments
