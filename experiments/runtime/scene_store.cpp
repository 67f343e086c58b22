#include "experiments/runtime/scene_store.h"

#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "experiments/runtime/scene_hash.h"

#include <algorithm>
#include <system_error>

namespace qtrace::experiments {

const LoadedScene& SceneStore::load(const std::filesystem::path& file) {
  const auto key = file.lexically_normal();
  const auto found = scenes_.find(key);
  if (found != scenes_.end()) return found->second;
  std::error_code unreadable;  // a name that is too long, say
  check(std::filesystem::is_regular_file(file, unreadable),
        "{}: no such scene; key 'scene' is relative to the config file", file.string());
  LoadedScene loaded{file, load_gltf(file), ""};
  loaded.hash = scene_hash(loaded.scene);
  return scenes_.emplace(key, std::move(loaded)).first->second;
}

bool has_light(const Scene& scene) {
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&scene](const Triangle& triangle) {
    return scene.materials[triangle.material].emission != glm::vec3(0.0F);
  });
}

}  // namespace qtrace::experiments
