#include "experiments/hash.h"

#include <xxhash.h>

#include <memory>

namespace qtrace::experiments {
namespace {

std::string hex(const XXH128_hash_t& hash) { return fmt::format("{:016x}{:016x}", hash.high64, hash.low64); }

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

  // The bytes of values that have no padding.
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    XXH3_128bits_update(state_.get(), &value, sizeof(T));
  }
  std::string digest() const { return hex(XXH3_128bits_digest(state_.get())); }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

void add_material(Hasher& hasher, const Material& material) {
  hasher.add(material.base_color);
  hasher.add(material.metallic);
  hasher.add(material.roughness);
  hasher.add(material.specular);
  hasher.add(material.specular_color);
  hasher.add(material.emission);
  hasher.add(material.double_sided);
}

}  // namespace

std::string hash_text(std::string_view text) { return hex(XXH3_128bits(text.data(), text.size())); }

std::string scene_hash(const Scene& scene) {
  static_assert(sizeof(Triangle) == 26 * 4, "padding would make equal triangles hash differently");
  Hasher hasher;
  hasher.add(scene.triangles.size());
  for (const Triangle& triangle : scene.triangles) hasher.add(triangle);
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
  return hasher.digest();
}

std::string config_hash(const RunConfig& config, const std::string& scene_hash) {
  Json json = write_knobs(config);
  json.erase("name");
  json.erase("save_table");
  json.erase("expect");
  for (const std::string_view key : kKeysOfExecution) json.erase(std::string(key));
  json["scene"] = scene_hash;
  return hash_text(canonical_text(json));
}

}  // namespace qtrace::experiments
