// What of the textures of a document the materials read.
#pragma once

#include "engine/scene/texture.h"

#include <glm/mat3x2.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::gltf {

// How a material names a texture.
struct TextureUse {
  TextureSlot slot = TextureSlot::base_color;
  std::string_view property;  // "baseColorTexture"
  std::size_t texture = 0;    // of the document
  std::size_t uv_set = 0;
  glm::mat3x2 image_from_uv{1, 0, 0, 1, 0, 0};
  float scale = 1;  // of normals
};

// A texture of the document with its sampler.
struct TextureSource {
  std::optional<std::size_t> image;  // of Textures::images; none where the file says no more
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  bool is_nearest = false;
};

// The bytes of a PNG or JPEG, of Source::model.buffers.
struct ImageBytes {
  std::string label;  // for messages
  std::string name;
  std::string media_type;  // as the file calls it; may be empty
  std::size_t buffer = 0;
  std::size_t offset = 0;
  std::size_t length = 0;
};

struct Textures {
  std::vector<std::vector<TextureUse>> uses;     // by material; none of those that no primitive has
  std::map<std::size_t, TextureSource> sources;  // by their indices in the document; those that are used
  std::vector<ImageBytes> images;                // of these, each once
};

}  // namespace qtrace::gltf
