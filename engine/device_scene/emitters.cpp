#include "engine/device_scene/emitters.h"

#include "engine/device_scene/texture_table.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace qtrace::gpu {
namespace {

// Points along each side of a triangle at which a texture is averaged, at most: for choosing lights a percent
// will do.
constexpr int kMostPoints = 64;
// Of the brightest texel, where the average misses all that is lit.
constexpr double kLeastShare = 1e-4;

double mean(const glm::vec3& v) { return (double{v.r} + double{v.g} + double{v.b}) / 3; }

glm::dvec2 image_place(const Texture& texture, const TextureImage& image, const glm::vec2& uv) {
  const glm::vec2 p = texture.image_from_uv * glm::vec3(uv, 1);
  return {double{p.x} * image.width, double{p.y} * image.height};
}

std::size_t wrapped(double i, std::uint32_t side, Wrap wrap) {
  const double period = wrap == Wrap::mirrored_repeat ? 2.0 * side : 1.0 * side;
  double repeated = i - period * std::floor(i / period);
  if (repeated >= side) repeated = 2.0 * side - 1 - repeated;
  return static_cast<std::size_t>(std::clamp(wrap == Wrap::clamp_to_edge ? i : repeated, 0.0, side - 1.0));
}

}  // namespace

// Brightness of the texels, and how many of them are lit above and left of each.
struct Emitters::Lamp {
  Lamp(const Texture& texture, const TextureImage& texels, const glm::vec3& emission)
      : use(texture),
        image(texels),
        lit_before((texels.width + std::size_t{1}) * (texels.height + std::size_t{1})) {
    for (std::size_t y = 0; y < image.height; ++y) {
      std::uint32_t in_row = 0;
      for (std::size_t x = 0; x < image.width; ++x) {
        const glm::dvec4 c = decoded(image.texels[y * image.width + x], TextureSlot::emission);
        const double b = mean(glm::vec3(c) * emission);
        brightness.push_back(static_cast<float>(b));
        brightest = std::max(brightest, b);
        if (b > 0) ++in_row;
        lit_before[(y + 1) * (image.width + std::size_t{1}) + x + 1] =
            in_row + lit_before[y * (image.width + std::size_t{1}) + x + 1];
      }
    }
  }

  // In columns [x0, x1) and rows [y0, y1).
  std::uint32_t lit(std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1) const {
    const std::size_t stride = image.width + std::size_t{1};
    return lit_before[y1 * stride + x1] - lit_before[y0 * stride + x1] - lit_before[y1 * stride + x0] +
           lit_before[y0 * stride + x0];
  }

  // At a place in texels from the corner, bilinear or not.
  double at(const glm::dvec2& place) const {
    const auto texel = [&](double x, double y) {
      return double{brightness[wrapped(y, image.height, use.wrap_v) * image.width +
                               wrapped(x, image.width, use.wrap_u)]};
    };
    if (use.is_nearest) return texel(std::floor(place.x), std::floor(place.y));
    const glm::dvec2 low = glm::floor(place - 0.5);
    const glm::dvec2 part = place - 0.5 - low;
    return glm::mix(glm::mix(texel(low.x, low.y), texel(low.x + 1, low.y), part.x),
                    glm::mix(texel(low.x, low.y + 1), texel(low.x + 1, low.y + 1), part.x), part.y);
  }

  const Texture& use;
  const TextureImage& image;
  std::vector<float> brightness;
  std::vector<std::uint32_t> lit_before;
  double brightest = 0;
};

namespace {

// Places in the image, in texels, of a triangle's corners.
std::array<glm::dvec2, 3> corners_in(const Texture& use, const TextureImage& image, const Scene& scene,
                                     const Triangle& t) {
  std::array<glm::dvec2, 3> places;
  for (std::size_t i = 0; i < 3; ++i) {
    glm::vec2 uv = t.uv[i];
    if (use.uv_set == 1)
      uv = t.attributes == kNoAttributes ? glm::vec2(0) : scene.attributes[t.attributes].uv1[i];
    places[i] = image_place(use, image, uv);
  }
  return places;
}

struct Range {
  std::size_t begin, end;
};

// The columns or rows between two places that bilinear values there depend on; all of them where they wrap.
Range texels_between(double low, double high, std::uint32_t side, Wrap wrap) {
  const double first = std::floor(low - 1), last = std::ceil(high + 1);
  if (wrap != Wrap::clamp_to_edge && (first < 0 || last >= side)) return {0, side};
  const double most = side - 1.0;
  return {static_cast<std::size_t>(std::clamp(first, 0.0, most)),
          static_cast<std::size_t>(std::clamp(last, 0.0, most)) + 1};
}

}  // namespace

Emitters::Emitters(const Scene& scene) : scene_(scene) {
  for (const qtrace::Material& material : scene.materials) {
    const auto& texture = material.texture(TextureSlot::emission);
    const bool shines = texture && material.emission != glm::vec3(0);
    lamps_.push_back(
        shines ? std::make_unique<Lamp>(*texture, scene.images[texture->image], material.emission) : nullptr);
  }
}

Emitters::~Emitters() = default;

const Emitters::Lamp* Emitters::lamp_of(std::uint32_t triangle) const {
  return lamps_[scene_.triangles[triangle].material].get();
}

bool Emitters::emits(std::uint32_t triangle) const {
  const Triangle& t = scene_.triangles[triangle];
  const qtrace::Material& material = scene_.materials[t.material];
  if (material.emission == glm::vec3(0) || material.is_unlit) return false;
  const Lamp* lamp = lamp_of(triangle);
  if (lamp == nullptr) return true;
  const auto p = corners_in(lamp->use, lamp->image, scene_, t);
  const glm::dvec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
  const Range x = texels_between(low.x, high.x, lamp->image.width, lamp->use.wrap_u);
  const Range y = texels_between(low.y, high.y, lamp->image.height, lamp->use.wrap_v);
  return lamp->lit(x.begin, x.end, y.begin, y.end) > 0;
}

double Emitters::mean_radiance(std::uint32_t triangle) const {
  const Triangle& t = scene_.triangles[triangle];
  const Lamp* lamp = lamp_of(triangle);
  if (lamp == nullptr) return mean(scene_.materials[t.material].emission);
  const auto p = corners_in(lamp->use, lamp->image, scene_, t);
  const glm::dvec2 extent = glm::max(p[0], glm::max(p[1], p[2])) - glm::min(p[0], glm::min(p[1], p[2]));
  const int points = static_cast<int>(std::clamp(2 * std::max(extent.x, extent.y), 1.0, 1.0 * kMostPoints));
  double sum = 0;
  // Middles of points^2 congruent parts of the triangle.
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < 2 * (points - i) - 1; ++j) {
      const double shift = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
      const double a = (i + shift) / points, b = (j / 2 + shift) / points;
      sum += lamp->at((1 - a - b) * p[0] + a * p[1] + b * p[2]);
    }
  }
  return std::max(sum / (1.0 * points * points), kLeastShare * lamp->brightest);
}

}  // namespace qtrace::gpu
