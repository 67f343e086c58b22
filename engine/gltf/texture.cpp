#include "engine/gltf/texture.h"

#include "engine/picture/picture.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace qtrace::gltf {
namespace {

class ImageReader {
 public:
  ImageReader(Source& source, const SceneLimits& limits, Scene& scene)
      : source_(source), scene_(scene), max_texels_(limits.texels), rest_(limits.texels) {}

  // By their indices in Textures::images: the scene's.
  std::vector<std::uint32_t> read_all() {
    std::vector<std::uint32_t> indices;
    for (const ImageBytes& image : source_.textures.images) indices.push_back(read(image));
    return indices;
  }

 private:
  std::uint32_t read(const ImageBytes& image) {
    const std::vector<unsigned char>& buffer = source_.model.buffers.at(image.buffer).data;
    const picture::Bytes bytes = picture::Bytes(buffer).subspan(image.offset, image.length);
    const std::string what = fmt::format("{}: {}", source_.file, image.label);
    const picture::Size size = picture::read_size(bytes, what);
    check_type(image, picture::media_type(bytes));
    const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
    const auto next = static_cast<std::uint32_t>(scene_.images.size());
    const auto [known, is_new] = by_content_.try_emplace({hash.high64, hash.low64}, next);
    if (!is_new) return known->second;
    const std::size_t texels = std::size_t{size.width} * size.height;
    source_.check(texels <= rest_,
                  "{} has {} x {} texels, and all images together more than {}, which is the most supported",
                  image.label, size.width, size.height, max_texels_);
    rest_ -= texels;
    scene_.images.push_back(picture::decode(bytes, what));
    scene_.images.back().name = image.name.empty() ? image.label : image.name;
    return next;
  }

  void check_type(const ImageBytes& image, std::string_view found) {
    if (image.media_type.empty() || image.media_type == found) return;
    source_.warn("{} is called {} and is {}; it is read as what it is", image.label,
                 shortened(image.media_type, 60), found);
  }

  Source& source_;
  Scene& scene_;
  std::size_t max_texels_, rest_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> by_content_;
};

void check_use(const Source& source, const TextureUse& use, const std::string& material) {
  source.check(use.uv_set <= 1, "{}: {} has coordinates TEXCOORD_{}; TEXCOORD_0 or TEXCOORD_1 would be right",
               material, use.property, use.uv_set);
  for (int column = 0; column < 3; ++column) {
    source.check(std::isfinite(use.image_from_uv[column].x) && std::isfinite(use.image_from_uv[column].y),
                 "{}: {} has a KHR_texture_transform that overflows; smaller numbers would be right",
                 material, use.property);
  }
}

Texture texture_of(const TextureSource& file, std::uint32_t image, const TextureUse& use) {
  Texture texture;
  texture.image = image;
  texture.wrap_u = file.wrap_u;
  texture.wrap_v = file.wrap_v;
  texture.is_nearest = file.is_nearest;
  texture.uv_set = static_cast<std::uint8_t>(use.uv_set);
  texture.image_from_uv = use.image_from_uv;
  return texture;
}

}  // namespace

void add_textures(Source& source, const SceneLimits& limits, Scene& scene) {
  const std::vector<std::uint32_t> images = ImageReader(source, limits, scene).read_all();
  const Textures& textures = source.textures;
  for (std::size_t i = 0; i < textures.uses.size(); ++i) {
    const std::string place = label("material", i, source.model.materials[i].name);
    for (const TextureUse& use : textures.uses[i]) {
      check_use(source, use, place);
      const TextureSource& file = textures.sources.at(use.texture);
      if (!file.image) {
        source.warn("{}: {} is texture {}, which has no image; the factors alone are used", place,
                    use.property, use.texture);
        continue;
      }
      Material& material = scene.materials[i];
      material.texture(use.slot) = texture_of(file, images[*file.image], use);
      if (use.slot == TextureSlot::normal) material.normal_scale = use.scale;
      if (use.slot == TextureSlot::clearcoat_normal) material.clearcoat_normal_scale = use.scale;
    }
  }
}

bool reads_uv_set(const Material& material, std::size_t set) {
  return std::ranges::any_of(material.textures, [set](const std::optional<Texture>& texture) {
    return texture.has_value() && texture->uv_set == set;
  });
}

const Texture* normal_texture(const Material& material) {
  for (const TextureSlot slot : {TextureSlot::normal, TextureSlot::clearcoat_normal}) {
    if (material.texture(slot)) return &*material.texture(slot);
  }
  return nullptr;
}

}  // namespace qtrace::gltf
