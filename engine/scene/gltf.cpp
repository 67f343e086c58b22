#include "engine/scene/gltf.h"

#include "engine/scene/gltf_buffer.h"
#include "engine/scene/gltf_camera.h"
#include "engine/scene/gltf_duplicates.h"
#include "engine/scene/gltf_features.h"
#include "engine/scene/gltf_file.h"
#include "engine/scene/gltf_json.h"
#include "engine/scene/gltf_material.h"
#include "engine/scene/gltf_mesh.h"
#include "engine/scene/gltf_node.h"
#include "engine/scene/gltf_origin.h"

#include <algorithm>

namespace qtrace {
namespace gltf {
namespace {

// tinygltf gets no more than the tracer models: it would decode images, follow buffers out of the scene's
// folder, and refuse files for mistakes in what is not used.
void parse_model(Source& source, nlohmann::json document) {
  for (const char* unused :
       {"animations", "buffers", "extensions", "images", "samplers", "skins", "textures"}) {
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

void read_source(Source& source, const std::filesystem::path& file) {
  FileContent content = read_scene_file(file);
  nlohmann::json document = parse_json(source, content.json);
  check_json(source, document);
  check_features(source, document);
  std::vector<tinygltf::Buffer> buffers =
      load_buffers(source, document, file.parent_path(), std::move(content));
  parse_model(source, std::move(document));
  source.model.buffers = std::move(buffers);
}

}  // namespace
}  // namespace gltf

Scene load_gltf(const std::filesystem::path& file) {
  gltf::Source source{file.string(), {}, {}};
  gltf::read_source(source, file);
  Scene scene;
  scene.name = file.stem().string();
  scene.materials = gltf::read_materials(source);
  std::vector<gltf::PlacedNode> nodes = gltf::place_nodes(source);
  scene.origin = gltf::centre_nodes(source, nodes);
  scene.camera = gltf::read_camera(source, nodes);
  gltf::add_objects(source, nodes, scene);
  gltf::drop_duplicates(source, scene);
  scene.warnings = std::move(source.warnings);
  return scene;
}

}  // namespace qtrace
