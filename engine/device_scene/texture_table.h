// The textures that materials use, packed for the device.
#pragma once

#include "engine/gpu/structs.h"
#include "engine/scene/scene.h"

#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace qtrace::gpu {

// As the shaders read a texel: colours linear, normals from -1 to 1, four numbers of 16 bits (IEEE half).
using HalfTexel = std::array<std::uint16_t, 4>;

struct TextureTable {
  std::vector<HalfTexel> texels;  // image by image; one for each way of decoding it
  std::vector<TextureUse> uses;   // by materials, then by slots
  std::vector<std::array<std::uint32_t, kTextureSlots>> of;  // by material: indices of `uses`, or NO_TEXTURE
  std::uint32_t slots = 0;                                   // a bit for each TextureSlot that is used
};

TextureTable build_texture_table(const Scene& scene);

// How many texels that table has.
std::size_t count_texels(const Scene& scene);

// A texel as a slot means it.
glm::dvec4 decoded(const TextureImage::Texel& texel, TextureSlot slot);

}  // namespace qtrace::gpu
