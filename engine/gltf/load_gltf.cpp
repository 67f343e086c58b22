#include "engine/gltf/load_gltf.h"

#include "engine/gltf/camera.h"
#include "engine/gltf/duplicates.h"
#include "engine/gltf/instances.h"
#include "engine/gltf/light.h"
#include "engine/gltf/material.h"
#include "engine/gltf/mesh.h"
#include "engine/gltf/node.h"
#include "engine/gltf/origin.h"
#include "engine/gltf/overlaps.h"
#include "engine/gltf/texture.h"
#include "engine/gltf_document/document.h"

namespace qtrace {
namespace gltf {
namespace {

Scene make_scene(FileContent content, const std::filesystem::path& file, const View& view,
                 const SceneLimits& limits) {
  Source source = read_document(std::move(content), file, limits);
  Scene scene;
  scene.name = file.stem().string();
  scene.materials = read_materials(source);
  add_textures(source, limits, scene);
  std::vector<PlacedNode> nodes = with_instances(source, place_nodes(source, view.scene), limits.primitives);
  scene.triangles.reserve(count_triangles(source, nodes, limits));
  scene.origin = centre_nodes(source, nodes);
  const float extent = add_objects(source, nodes, scene);
  scene.lights = read_lights(source, nodes);
  add_camera(source, nodes, view, scene);
  drop_duplicates(source, scene);
  cut_overlaps(source, scene, extent, limits.triangles);
  scene.warnings = std::move(source.warnings);
  if (source.more_warnings > 0) {
    scene.warnings.push_back(fmt::format("{} more warnings are left out", source.more_warnings));
  }
  return scene;
}

}  // namespace
}  // namespace gltf

Scene load_gltf(const std::filesystem::path& file, const View& view) {
  gltf::FileContent content = gltf::split_content(gltf::read_scene_file(file), file);
  return gltf::make_scene(std::move(content), file, view, {});
}

Scene parse_gltf(std::span<const unsigned char> bytes, const std::filesystem::path& file, const View& view,
                 const SceneLimits& limits) {
  return gltf::make_scene(gltf::split_content(bytes, file), file, view, limits);
}

}  // namespace qtrace
