#include "engine/gltf_document/document.h"

#include "engine/gltf_document/buffer.h"
#include "engine/gltf_document/draco.h"
#include "engine/gltf_document/expansion.h"
#include "engine/gltf_document/features.h"
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

// tinygltf gets no more than the tracer models: it would decode images, follow buffers out of the scene's
// folder, and refuse files for mistakes in what is not used.
void parse_model(Source& source, nlohmann::json document) {
  for (const char* unused : {"animations", "buffers", "extensions", "images", "samplers", "textures"}) {
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
  Source source{file.string(), {}, {}, 0};
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
  return source;
}

}  // namespace qtrace::gltf
