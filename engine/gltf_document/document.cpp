#include "engine/gltf_document/document.h"

#include "engine/gltf_document/buffer.h"
#include "engine/gltf_document/draco.h"
#include "engine/gltf_document/expansion.h"
#include "engine/gltf_document/features.h"
#include "engine/gltf_document/image.h"
#include "engine/gltf_document/json.h"
#include "engine/gltf_document/meshopt.h"
#include "engine/gltf_document/schema.h"

#include <algorithm>

namespace qtrace::gltf {
namespace {

// Skins may leave out these matrices, and tinygltf refuses skins that do. -1 is its own word for "none".
void mark_missing_bind_matrices(nlohmann::json& skins) {
  for (nlohmann::json& skin : skins) {
    if (!skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
  }
}

// Of the document's own extensions no other is read.
void keep_lights(nlohmann::json& document) {
  constexpr const char* kLights = "KHR_lights_punctual";
  const auto extensions = document.find("extensions");
  if (extensions == document.end()) return;
  nlohmann::json kept = nlohmann::json::object();
  if (extensions->is_object() && extensions->contains(kLights)) kept[kLights] = (*extensions)[kLights];
  *extensions = std::move(kept);
}

// tinygltf gets no more than the tracer models: it would decode images, follow buffers out of the scene's
// folder, and refuse files for mistakes in what is not used.
void parse_model(Source& source, nlohmann::json document) {
  keep_lights(document);
  for (const char* unused : {"animations", "buffers", "images", "samplers", "textures"}) {
    document.erase(unused);
  }
  if (document.contains("skins")) mark_missing_bind_matrices(document["skins"]);
  const std::string text = document.dump();
  tinygltf::TinyGLTF parser;
  std::string errors;
  std::string warnings;
  const bool is_parsed = parser.LoadASCIIFromString(&source.model, &errors, &warnings, text.c_str(),
                                                    static_cast<unsigned>(text.size()), "");
  std::replace(errors.begin(), errors.end(), '\n', ' ');
  source.check(is_parsed && errors.empty(), "the glTF is not valid: {}", errors);
}

}  // namespace

Source read_document(FileContent content, const std::filesystem::path& file, const SceneLimits& limits) {
  Source source;
  source.file = file.string();
  nlohmann::json document = parse_json(source, content.json);
  check_json(source, document);
  check_features(source, document);
  std::vector<tinygltf::Buffer> buffers =
      load_buffers(source, document, file.parent_path(), std::move(content), limits.file_bytes);
  decode_meshopt(source, document, buffers, limits.expanded_bytes);
  decode_draco(source, document, buffers, limits.expanded_bytes);
  expand_accessors(source, document, buffers, limits.expanded_bytes);
  source.textures = find_textures(source, document, buffers, file.parent_path(), limits.file_bytes);
  parse_model(source, std::move(document));
  source.model.buffers = std::move(buffers);
  return source;
}

}  // namespace qtrace::gltf
