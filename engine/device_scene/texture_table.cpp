#include "engine/device_scene/texture_table.h"

#include <glm/gtc/packing.hpp>

#include <bit>
#include <cmath>
#include <map>
#include <utility>

namespace qtrace::gpu {
namespace {

constexpr double kLargestCode = 65535;

// IEC 61966-2-1: sRGB to linear.
double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

enum class Decoding : std::uint8_t { linear, srgb, normal };

Decoding decoding_of(TextureSlot slot) {
  if (slot == TextureSlot::normal || slot == TextureSlot::clearcoat_normal) return Decoding::normal;
  return is_srgb(slot) ? Decoding::srgb : Decoding::linear;
}

double decode(std::uint16_t code, Decoding decoding) {
  const double c = code / kLargestCode;
  switch (decoding) {
    case Decoding::srgb:
      return linear(c);
    case Decoding::normal:
      return 2 * c - 1;
    case Decoding::linear:
      break;
  }
  return c;
}

std::uint16_t as_half(double value) { return glm::packHalf1x16(static_cast<float>(value)); }

// What every code of a channel becomes; worked out where a scene first asks for it.
class DecodedCodes {
 public:
  const std::vector<std::uint16_t>& of(Decoding decoding) {
    std::vector<std::uint16_t>& halves = halves_[decoding];
    if (!halves.empty()) return halves;
    for (std::uint32_t code = 0; code <= 0xffff; ++code) {
      halves.push_back(as_half(decode(static_cast<std::uint16_t>(code), decoding)));
    }
    return halves;
  }

 private:
  std::map<Decoding, std::vector<std::uint16_t>> halves_;
};

void append_texels(std::vector<HalfTexel>& texels, const TextureImage& image, Decoding decoding,
                   DecodedCodes& codes) {
  const auto& halves = codes.of(decoding);
  const auto& alphas = codes.of(Decoding::linear);
  for (const TextureImage::Texel& t : image.texels) {
    texels.push_back({halves[t[0]], halves[t[1]], halves[t[2]], alphas[t[3]]});
  }
}

// An image that is decoded in two ways stands there twice.
class TexelPlaces {
 public:
  // Of the image's first texel, which `append` puts there when it is asked for first.
  template <class Append>
  std::size_t of(std::uint32_t image, TextureSlot slot, Append append) {
    const auto [found, is_new] = places_.try_emplace({image, decoding_of(slot)}, 0);
    if (is_new) found->second = append(decoding_of(slot));
    return found->second;
  }

 private:
  std::map<std::pair<std::uint32_t, Decoding>, std::size_t> places_;
};

TextureUse make_use(const Texture& texture, const TextureImage& image, std::size_t first) {
  const auto& m = texture.image_from_uv;  // columns
  const auto width = static_cast<float>(image.width), height = static_cast<float>(image.height);
  TextureUse use{};
  use.u_row = vec4(m[0].x * width, m[1].x * width, m[2].x * width - 0.5F,
                   std::bit_cast<float>(static_cast<std::uint32_t>(first)));
  const std::uint32_t sides = (image.width - 1) | (image.height - 1) << TEXTURE_SIDE_BITS;
  use.v_row = vec4(m[0].y * height, m[1].y * height, m[2].y * height - 0.5F, std::bit_cast<float>(sides));
  use.modes = uvec4(static_cast<uint>(texture.wrap_u), static_cast<uint>(texture.wrap_v),
                    texture.is_nearest ? 1 : 0, texture.uv_set);
  return use;
}

template <class Visit>
void for_each_texture(const Scene& scene, Visit visit) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
      const auto& texture = scene.materials[m].textures[slot];
      if (texture) visit(m, static_cast<TextureSlot>(slot), *texture);
    }
  }
}

}  // namespace

glm::dvec4 decoded(const TextureImage::Texel& texel, TextureSlot slot) {
  const Decoding decoding = decoding_of(slot);
  return {decode(texel[0], decoding), decode(texel[1], decoding), decode(texel[2], decoding),
          decode(texel[3], Decoding::linear)};
}

std::size_t count_texels(const Scene& scene) {
  TexelPlaces places;
  std::size_t count = 0;
  for_each_texture(scene, [&](std::size_t, TextureSlot slot, const Texture& texture) {
    places.of(texture.image, slot, [&](Decoding) {
      count += scene.images[texture.image].texels.size();
      return count;
    });
  });
  return count;
}

TextureTable build_texture_table(const Scene& scene) {
  TextureTable table;
  table.texels.reserve(count_texels(scene));
  std::array<std::uint32_t, kTextureSlots> none{};
  none.fill(NO_TEXTURE);
  table.of.assign(scene.materials.size(), none);
  TexelPlaces places;
  DecodedCodes codes;
  for_each_texture(scene, [&](std::size_t material, TextureSlot slot, const Texture& texture) {
    const TextureImage& image = scene.images[texture.image];
    const std::size_t first = places.of(texture.image, slot, [&](Decoding decoding) {
      const std::size_t begin = table.texels.size();
      append_texels(table.texels, image, decoding, codes);
      return begin;
    });
    table.of[material][static_cast<std::size_t>(slot)] = static_cast<std::uint32_t>(table.uses.size());
    table.uses.push_back(make_use(texture, image, first));
    table.slots |= 1U << static_cast<unsigned>(slot);
  });
  return table;
}

}  // namespace qtrace::gpu
