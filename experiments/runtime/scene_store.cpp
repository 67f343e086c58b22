#include "experiments/runtime/scene_store.h"

#include "engine/core/check.h"
#include "engine/gltf/load_gltf.h"
#include "experiments/config/view_knobs.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/environment_file.h"
#include "experiments/runtime/scene_hash.h"

#include <glm/trigonometric.hpp>

#include <algorithm>

namespace qtrace::experiments {
namespace {

void add_environment(const EnvironmentImage& image, LoadedScene& loaded) {
  const auto& scale = image.scale.rgb;
  EnvironmentMap map = read_environment(image.file, {scale[0], scale[1], scale[2]});
  map.rotation = static_cast<float>(glm::radians(image.rotation));
  if (map.width != 2 * map.height)
    loaded.scene.warnings.push_back(
        fmt::format("the environment {} has {}x{} texels; all directions in latitude and longitude are twice "
                    "as wide as high, so that it is stretched",
                    image.file, map.width, map.height));
  loaded.scene.environment = std::move(map);
  loaded.environment_file = image.file;
}

}  // namespace

std::string view_text(const View& view) {
  std::string text;
  if (view.scene.is_given()) text += ", scene " + KnobType<NameOrIndex>::write(view.scene).dump();
  if (view.camera != CameraChoice()) text += ", camera " + KnobType<CameraChoice>::write(view.camera).dump();
  // What fits depends on the picture's shape.
  if (view.camera.kind == CameraChoice::Kind::fit) text += fmt::format(" at {:g} to 1", view.aspect);
  return text;
}

std::string environment_text(const std::optional<EnvironmentImage>& environment) {
  return environment ? ", environment " + environment_json(*environment).dump() : "";
}

const LoadedScene& SceneStore::load(const std::filesystem::path& file, const View& view,
                                    const std::optional<EnvironmentImage>& environment) {
  const std::string key = fmt::format("{}\n{}\n{}\n{}", file.lexically_normal().string(), view_text(view),
                                      view.aspect, environment_text(environment));
  const auto found = scenes_.find(key);
  if (found != scenes_.end()) return found->second;
  check(is_file(file), "{}: no such scene; key 'scene' is relative to the config file", file.string());
  LoadedScene loaded{file, view, load_gltf(file, view), ""};
  if (environment) add_environment(*environment, loaded);
  loaded.hash = scene_hash(loaded.scene);
  return scenes_.emplace(key, std::move(loaded)).first->second;
}

bool has_light(const Scene& scene) {
  const auto is_lit = [](const glm::vec3& radiance) { return radiance != glm::vec3(0.0F); };
  if (scene.environment && std::ranges::any_of(scene.environment->radiance, is_lit)) return true;
  if (std::ranges::any_of(scene.lights, [&](const PunctualLight& light) { return is_lit(light.intensity); }))
    return true;
  return std::ranges::any_of(scene.triangles, [&](const Triangle& triangle) {
    const Material& material = scene.materials[triangle.material];
    return is_lit(material.is_unlit ? material.base_color : material.emission);
  });
}

}  // namespace qtrace::experiments
