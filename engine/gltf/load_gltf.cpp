#include "engine/gltf/load_gltf.h"

#include "engine/gltf/buffer.h"
#include "engine/gltf/camera.h"
#include "engine/gltf/draco.h"
#include "engine/gltf/duplicates.h"
#include "engine/gltf/expansion.h"
#include "engine/gltf/features.h"
#include "engine/gltf/file.h"
#include "engine/gltf/instances.h"
#include "engine/gltf/json.h"
#include "engine/gltf/material.h"
#include "engine/gltf/mesh.h"
#include "engine/gltf/meshopt.h"
#include "engine/gltf/node.h"
#include "engine/gltf/origin.h"
#include "engine/gltf/overlaps.h"
#include "engine/gltf/schema.h"

#include <algorithm>

namespace qtrace {
namespace gltf {
namespace {

// tinygltf gets no more than the tracer models: it would decode images, follow buffers out of the scene's
// folder, and refuse files for mistakes in what is not used.
void parse_model(Source& source, nlohmann::json document) {
  for (const char* unused : {"animations", "buffers", "extensions", "images", "samplers", "textures"}) {
    document.erase(unused);
  }
  const std::string text = document.dump();
  tinygltf::TinyGLTF parser;
  std::string errors;
  std::string warnings;
  const bool is_parsed = parser.LoadASCIIFromString(&source.model, &errors, &warnings, text.c_str(),
                                                    static_cast<unsigned>(text.size()), "");
  std::replace(errors.begin(), errors.end(), '\n', ' ');
  source.check(is_parsed && errors.empty(), "the glTF is not valid: {}", errors);
}

void read_source(Source& source, FileContent content, const std::filesystem::path& file,
                 const SceneLimits& limits) {
  nlohmann::json document = parse_json(source, content.json);
  check_json(source, document);
  check_features(source, document);
  std::vector<tinygltf::Buffer> buffers =
      load_buffers(source, document, file.parent_path(), std::move(content), limits.file_bytes);
  decode_meshopt(source, document, buffers, limits.expanded_bytes);
  decode_draco(source, document, buffers, limits.expanded_bytes);
  expand_accessors(source, document, buffers, limits.expanded_bytes);
  parse_model(source, std::move(document));
  source.model.buffers = std::move(buffers);
}

Scene make_scene(FileContent content, const std::filesystem::path& file, const View& view,
                 const SceneLimits& limits) {
  Source source{file.string(), {}, {}, 0};
  read_source(source, std::move(content), file, limits);
  Scene scene;
  scene.name = file.stem().string();
  scene.materials = read_materials(source);
  std::vector<PlacedNode> nodes = with_instances(source, place_nodes(source, view.scene), limits.primitives);
  scene.triangles.reserve(count_triangles(source, nodes, limits));
  scene.origin = centre_nodes(source, nodes);
  add_objects(source, nodes, scene);
  add_camera(source, nodes, view, scene);
  drop_duplicates(source, scene);
  cut_overlaps(source, scene);
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
