#include "experiments/runtime/scene_store.h"

#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "experiments/config/view_knobs.h"
#include "experiments/files/atomic_file.h"
#include "experiments/runtime/scene_hash.h"

#include <algorithm>

namespace qtrace::experiments {

std::string view_text(const View& view) {
  std::string text;
  if (view.scene.is_given()) text += ", scene " + KnobType<NameOrIndex>::write(view.scene).dump();
  if (view.camera != CameraChoice()) text += ", camera " + KnobType<CameraChoice>::write(view.camera).dump();
  // What fits depends on the picture's shape.
  if (view.camera.kind == CameraChoice::Kind::fit) text += fmt::format(" at {:g} to 1", view.aspect);
  return text;
}

const LoadedScene& SceneStore::load(const std::filesystem::path& file, const View& view) {
  const std::string key =
      fmt::format("{}\n{}\n{}", file.lexically_normal().string(), view_text(view), view.aspect);
  const auto found = scenes_.find(key);
  if (found != scenes_.end()) return found->second;
  check(is_file(file), "{}: no such scene; key 'scene' is relative to the config file", file.string());
  LoadedScene loaded{file, view, load_gltf(file, view), ""};
  loaded.hash = scene_hash(loaded.scene);
  return scenes_.emplace(key, std::move(loaded)).first->second;
}

bool has_light(const Scene& scene) {
  return std::any_of(scene.triangles.begin(), scene.triangles.end(), [&scene](const Triangle& triangle) {
    return scene.materials[triangle.material].emission != glm::vec3(0.0F);
  });
}

}  // namespace qtrace::experiments
