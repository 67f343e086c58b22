#include "tests/independent/texture.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace qtrace::independent {
namespace {

constexpr std::size_t kValues = 65536;

// IEC 61966-2-1, for every value that a texel can have.
std::vector<double> decoded_values() {
  std::vector<double> table;
  for (std::size_t i = 0; i < kValues; ++i) {
    const double c = static_cast<double>(i) / (kValues - 1);
    table.push_back(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return table;
}

std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
  if (wrap == Wrap::clamp_to_edge) return std::min(std::max(i, std::int64_t{0}), size - 1);
  const std::int64_t period = wrap == Wrap::repeat ? size : 2 * size;
  const std::int64_t rest = (i % period + period) % period;
  return rest < size ? rest : period - 1 - rest;
}

glm::dvec4 texel(const TextureImage& image, const Texture& texture, bool is_coded, std::int64_t i,
                 std::int64_t j) {
  static const std::vector<double> decoded = decoded_values();
  const std::int64_t column = wrapped(i, image.width, texture.wrap_u);
  const std::int64_t row = wrapped(j, image.height, texture.wrap_v);
  const TextureImage::Texel& stored = image.texels[static_cast<std::size_t>(row * image.width + column)];
  glm::dvec4 value;
  for (int k = 0; k < 4; ++k) {
    const std::uint16_t channel = stored[static_cast<std::size_t>(k)];
    value[k] = is_coded && k < 3 ? decoded[channel] : channel / (kValues - 1.0);
  }
  return value;
}

}  // namespace

glm::dvec4 look_up(const Scene& scene, const Texture& texture, TextureSlot slot, const glm::dvec2& uv) {
  const TextureImage& image = scene.images[texture.image];
  const glm::dvec2 place = glm::dmat3x2(texture.image_from_uv) * glm::dvec3(uv, 1) *
                           glm::dvec2(image.width, image.height);  // in texels from the upper left corner
  const auto at = [&](double x, double y) {
    return texel(image, texture, is_srgb(slot), static_cast<std::int64_t>(x), static_cast<std::int64_t>(y));
  };
  if (texture.is_nearest) return at(std::floor(place.x), std::floor(place.y));
  const double x = std::floor(place.x - 0.5), y = std::floor(place.y - 0.5);
  const double right = place.x - 0.5 - x, down = place.y - 0.5 - y;
  return glm::mix(glm::mix(at(x, y), at(x + 1, y), right), glm::mix(at(x, y + 1), at(x + 1, y + 1), right),
                  down);
}

}  // namespace qtrace::independent
