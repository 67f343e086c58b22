#include "engine/device_scene/sky_table.h"

#include "engine/device_scene/alias_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace qtrace::gpu {
namespace {

double mean(const glm::vec3& v) { return (double{v.r} + double{v.g} + double{v.b}) / 3; }

// Mean over a texel of what is bilinear between the centres of its neighbours: an eighth of each side's,
// three quarters of its own, along both axes.
double mean_over_texel(const EnvironmentMap& map, std::uint32_t column, std::uint32_t row) {
  constexpr double kWeights[] = {0.125, 0.75, 0.125};
  double sum = 0;
  for (std::uint32_t dy = 0; dy < 3; ++dy) {
    const std::uint32_t y = row + dy == 0 ? 0 : std::min(row + dy - 1, map.height - 1);
    for (std::uint32_t dx = 0; dx < 3; ++dx) {
      const std::uint32_t x = (column + dx + map.width - 1) % map.width;
      sum += kWeights[dx] * kWeights[dy] * mean(map.radiance[std::size_t{y} * map.width + x]);
    }
  }
  return sum;
}

double solid_angle(const EnvironmentMap& map, std::uint32_t row) {
  const double upper = std::cos(std::numbers::pi * row / map.height);
  const double lower = std::cos(std::numbers::pi * (row + 1.0) / map.height);
  return 2 * std::numbers::pi / map.width * (upper - lower);
}

// What each texel brings, row by row: by these they are drawn.
std::vector<double> weights_of(const EnvironmentMap& map) {
  std::vector<double> weights;
  weights.reserve(map.radiance.size());
  for (std::uint32_t row = 0; row < map.height; ++row) {
    for (std::uint32_t column = 0; column < map.width; ++column) {
      weights.push_back(mean_over_texel(map, column, row) * solid_angle(map, row));
    }
  }
  return weights;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double mean_radiance(const EnvironmentMap& map) { return sum_of(weights_of(map)) / (4 * std::numbers::pi); }

std::vector<SkyTexel> build_sky_table(const EnvironmentMap& map) {
  const std::vector<double> weights = weights_of(map);
  const double total = sum_of(weights);
  std::vector<SkyTexel> texels;
  if (total <= 0) return texels;
  texels.reserve(weights.size());
  const std::vector<AliasSlot> slots = build_aliases(weights);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double density = weights[i] / total / solid_angle(map, static_cast<std::uint32_t>(i / map.width));
    texels.push_back({vec4(map.radiance[i], static_cast<float>(density)),
                      uvec4(slots[i].alias, slots[i].threshold, 0, 0)});
  }
  return texels;
}

}  // namespace qtrace::gpu
