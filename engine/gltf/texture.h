// The images of a scene, and how its materials use them.
#pragma once

#include "engine/gltf_document/limits.h"
#include "engine/gltf_document/source.h"
#include "engine/scene/scene.h"

#include <cstddef>

namespace qtrace::gltf {

// Decodes each image that a material reads, fills scene.images and gives scene.materials, the file's, their
// textures. Images of the same bytes are one. Warnings name textures without an image and images of another
// kind than the file says. Error, with the image's name, for broken ones and for more texels than
// `limits.texels`.
void add_textures(Source& source, const SceneLimits& limits, Scene& scene);

bool reads_uv_set(const Material& material, std::size_t set);
// The texture of normals along whose coordinates tangents lie; null where the material has none.
const Texture* normal_texture(const Material& material);

}  // namespace qtrace::gltf
