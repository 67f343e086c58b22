#include "engine/tracer/atrous.h"

#include "engine/core/check.h"
#include "engine/gpu/structs.h"
#include "engine/tracer/tiles.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>
#include <utility>

namespace qtrace {
namespace {

bool is_hit(const FirstHitImage& image, std::size_t pixel) { return image.normal[pixel] != glm::vec3(0); }

// Where the visible points are: their centre, and their root mean square distance from it.
struct View {
  glm::dvec3 centre{0.0};
  double size = 1;
};

View view_of(const FirstHitImage& image) {
  View view;
  double points = 0;
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < image.position.size(); ++i) {
    if (!is_hit(image, i)) continue;
    sum += glm::dvec3(image.position[i]);
    ++points;
  }
  if (points == 0) return view;
  view.centre = sum / points;
  double squares = 0;
  for (std::size_t i = 0; i < image.position.size(); ++i) {
    if (!is_hit(image, i)) continue;
    const glm::dvec3 from_centre = glm::dvec3(image.position[i]) - view.centre;
    squares += glm::dot(from_centre, from_centre) / points;
  }
  if (squares > 0) view.size = std::sqrt(squares);
  return view;
}

glm::vec3 is_divided(const glm::vec3& albedo) {
  return glm::vec3(glm::greaterThanEqual(albedo, glm::vec3(AtrousFilter::kLeastAlbedo)));
}

std::vector<gpu::FilterGuide> make_guides(const FirstHitImage& image) {
  const View view = view_of(image);
  std::vector<gpu::FilterGuide> guides;
  for (std::size_t i = 0; i < image.position.size(); ++i) {
    const glm::vec3 position((glm::dvec3(image.position[i]) - view.centre) / view.size);
    guides.push_back(
        {glm::vec4(image.normal[i], 0), glm::vec4(position, 0), glm::vec4(is_divided(image.albedo[i]), 0)});
  }
  return guides;
}

float falloff(double sigma) { return static_cast<float>(1 / (sigma * sigma)); }

}  // namespace

AtrousFilter::AtrousFilter(const gpu::Context& context, const FirstHitImage& first_hit,
                           const FilterSettings& settings)
    : context_(context),
      first_hit_(first_hit),
      settings_(settings),
      guides_("filter guides", make_guides(first_hit)),
      source_("filter source", first_hit.normal.size() * sizeof(gpu::vec4)),
      result_("filter result", first_hit.normal.size() * sizeof(gpu::vec4)),
      constants_("filter constants", sizeof(gpu::FilterPass)),
      program_("passes/atrous.comp", {}) {
  run_pass(0);
  context_.finish();
}

RadianceImage AtrousFilter::apply(const RadianceImage& image) {
  check(image.width == first_hit_.width && image.height == first_hit_.height,
        "an image of {}x{} pixels cannot be filtered with first hits of {}x{}", image.width, image.height,
        first_hit_.width, first_hit_.height);
  RadianceImage filtered{image.width, image.height, image.samples, image.mean, {}};
  const double level = mean_level(image);
  if (level <= 0) return filtered;
  std::vector<gpu::vec4> pixels(image.pixels(), gpu::vec4(0));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (takes_part(i, image.mean[i])) pixels[i] = gpu::vec4(image.mean[i] / divisor(i) / level, 1);
  }
  source_.write(0, pixels.data(), source_.bytes());
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    run_pass(iteration);
    std::swap(source_, result_);
  }
  pixels = source_.read_all<gpu::vec4>();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i].w > 0) filtered.mean[i] = glm::dvec3(pixels[i]) * level * divisor(i);
  }
  return filtered;
}

glm::dvec3 AtrousFilter::divisor(std::size_t pixel) const {
  const glm::vec3& albedo = first_hit_.albedo[pixel];
  return glm::mix(glm::dvec3(1), glm::dvec3(albedo), glm::dvec3(is_divided(albedo)));
}

bool AtrousFilter::takes_part(std::size_t pixel, const glm::dvec3& radiance) const {
  return is_hit(first_hit_, pixel) && first_hit_.emission[pixel] == glm::vec3(0) &&
         std::isfinite(radiance.x) && std::isfinite(radiance.y) && std::isfinite(radiance.z);
}

double AtrousFilter::mean_level(const RadianceImage& image) const {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    if (!takes_part(i, image.mean[i])) continue;
    const glm::dvec3 level = image.mean[i] / divisor(i);
    sum += level.x + level.y + level.z;
    count += 3;
  }
  return count > 0 ? sum / count : 0;
}

void AtrousFilter::run_pass(int iteration) {
  const auto width = static_cast<gpu::uint>(first_hit_.width);
  const auto height = static_cast<gpu::uint>(first_hit_.height);
  gpu::FilterPass constants{};
  constants.image_size = gpu::uvec2(width, height);
  constants.spacing = 1U << iteration;
  constants.radiance_falloff = falloff(std::ldexp(settings_.sigma_radiance, -iteration));
  constants.normal_falloff = falloff(settings_.sigma_normal);
  constants.position_falloff = falloff(settings_.sigma_position);
  constants_.write(0, &constants, sizeof(constants));
  constants_.bind_uniform(gpu::BINDING_PARAMETERS);
  guides_.bind_storage(gpu::BINDING_FILTER_GUIDES);
  source_.bind_storage(gpu::BINDING_FILTER_SOURCE);
  result_.bind_storage(gpu::BINDING_FILTER_RESULT);
  program_.dispatch(tiles(first_hit_.width), tiles(first_hit_.height));
}

}  // namespace qtrace
