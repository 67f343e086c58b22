// The images of a scene, and how its materials use them.
#pragma once

#include <glm/mat3x2.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace qtrace {

// RGBA as the file has it, not yet decoded from sRGB: rows from the top, values of 65535 for 1. Images of 8
// bits hold multiples of 257, which are the same numbers.
struct TextureImage {
  using Texel = std::array<std::uint16_t, 4>;

  std::string name;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<Texel> texels;
};

// What becomes of coordinates outside of [0, 1).
enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };

// What a texture is multiplied with (glTF 2.0 and its extensions for materials).
enum class TextureSlot : std::uint8_t {
  base_color,           // RGB in sRGB: base_color, A: alpha
  metallic_roughness,   // G: roughness, B: metallic
  normal,               // RGB: tangent-space normal, 2 c - 1
  emission,             // RGB in sRGB
  specular,             // A: specular
  specular_color,       // RGB in sRGB
  transmission,         // R
  clearcoat,            // R
  clearcoat_roughness,  // G
  clearcoat_normal,     // as `normal`
};
inline constexpr std::size_t kTextureSlots = 10;

constexpr bool is_srgb(TextureSlot slot) {
  return slot == TextureSlot::base_color || slot == TextureSlot::emission ||
         slot == TextureSlot::specular_color;
}

// An image as a material uses it. Texel (i, j) has its centre at ((i + 0.5) / width, (j + 0.5) / height) of
// the coordinates, v downwards; values between centres are bilinear, after decoding sRGB.
struct Texture {
  std::uint32_t image = 0;  // of Scene::images
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  bool is_nearest = false;  // the nearest texel instead of bilinear values
  std::uint8_t uv_set = 0;  // 0 or 1: of the triangle's coordinates
  // Image coordinates are this times (u, v, 1): KHR_texture_transform.
  glm::mat3x2 image_from_uv{1, 0, 0, 1, 0, 0};

  bool operator==(const Texture&) const = default;
};

}  // namespace qtrace
