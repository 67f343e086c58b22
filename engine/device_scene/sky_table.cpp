#include "engine/device_scene/sky_table.h"

#include "engine/device_scene/alias_table.h"

#include <cmath>
#include <numbers>

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

}  // namespace

SkyTable build_sky_table(const EnvironmentMap& map) {
  SkyTable table;
  std::vector<double> weights;
  double total = 0;
  for (std::uint32_t row = 0; row < map.height; ++row) {
    for (std::uint32_t column = 0; column < map.width; ++column) {
      weights.push_back(mean_over_texel(map, column, row) * solid_angle(map, row));
      total += weights.back();
    }
  }
  table.mean_radiance = total / (4 * std::numbers::pi);
  if (total <= 0) return table;
  const std::vector<AliasSlot> slots = build_aliases(weights);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double density = weights[i] / total / solid_angle(map, static_cast<std::uint32_t>(i / map.width));
    table.texels.push_back({vec4(map.radiance[i], static_cast<float>(density)),
                            uvec4(slots[i].alias, slots[i].threshold, 0, 0)});
  }
  return table;
}

}  // namespace qtrace::gpu
