#include "tests/independent/environment.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace qtrace::independent {
namespace {

constexpr double kPi = glm::pi<double>();

}  // namespace

Environment::Environment(const EnvironmentMap& map) : map_(map), up_to_(1, 0.0) {
  constexpr double kLeast = 0.02;  // of the mean: no direction is left out
  std::vector<double> near;
  double sum = 0;
  for (std::size_t i = 0; i < map.radiance.size(); ++i) {
    const auto column = static_cast<std::ptrdiff_t>(i % map.width),
               row = static_cast<std::ptrdiff_t>(i / map.width);
    double brightest = 0;
    for (std::ptrdiff_t k = 0; k < 9; ++k) {
      const glm::dvec3 c = texel(column + k % 3 - 1, row + k / 3 - 1);
      brightest = std::max(brightest, c.x + c.y + c.z);
    }
    near.push_back(brightest);
    sum += brightest * solid_angle(i / map.width);
  }
  const double least = sum > 0 ? kLeast * sum / (4 * kPi) : 1;
  for (std::size_t i = 0; i < near.size(); ++i) {
    up_to_.push_back(up_to_.back() + (near[i] + least) * solid_angle(i / map.width));
  }
  for (double& value : up_to_) value /= up_to_.back();
}

Environment::Place Environment::place(const glm::dvec3& direction) const {
  const double longitude =
      std::atan2(direction.x, -direction.z) + map_.rotation;  // from the middle to the right
  const double turns = longitude / (2 * kPi) + 0.5;
  const double polar = std::acos(std::clamp(direction.y, -1.0, 1.0));
  return {(turns - std::floor(turns)) * map_.width, polar / kPi * map_.height};
}

glm::dvec3 Environment::direction(double column, double cosine) const {
  const double longitude = 2 * kPi * (column / map_.width - 0.5) - map_.rotation;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::sin(longitude), cosine, -sine * std::cos(longitude)};
}

glm::dvec3 Environment::texel(std::ptrdiff_t column, std::ptrdiff_t row) const {
  const auto width = static_cast<std::ptrdiff_t>(map_.width),
             height = static_cast<std::ptrdiff_t>(map_.height);
  const std::ptrdiff_t i = (column % width + width) % width,
                       j = std::clamp<std::ptrdiff_t>(row, 0, height - 1);
  return glm::dvec3(map_.radiance[static_cast<std::size_t>(j * width + i)]);
}

double Environment::solid_angle(std::size_t row) const {
  const double step = kPi / map_.height, top = static_cast<double>(row) * step;
  return 2 * kPi / map_.width * (std::cos(top) - std::cos(top + step));
}

glm::dvec3 Environment::radiance(const glm::dvec3& direction) const {
  const Place at = place(direction);
  const double x = std::floor(at.column - 0.5), y = std::floor(at.row - 0.5);
  const double right = at.column - 0.5 - x, down = at.row - 0.5 - y;
  const auto i = static_cast<std::ptrdiff_t>(x), j = static_cast<std::ptrdiff_t>(y);
  return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), right),
                  glm::mix(texel(i, j + 1), texel(i + 1, j + 1), right), down);
}

Environment::Sample Environment::sample(Random& random) const {
  const auto after = std::upper_bound(up_to_.begin(), up_to_.end(), random());
  const auto found = std::clamp<std::ptrdiff_t>(after - up_to_.begin() - 1, 0,
                                                static_cast<std::ptrdiff_t>(up_to_.size()) - 2);
  const auto i = static_cast<std::size_t>(found);
  const std::size_t row = i / map_.width;
  const double step = kPi / map_.height, top = static_cast<double>(row) * step;
  const double cosine = glm::mix(std::cos(top), std::cos(top + step), random());
  const double column = static_cast<double>(i % map_.width) + random();
  return {direction(column, cosine), chance(i) / solid_angle(row)};
}

double Environment::density(const glm::dvec3& direction) const {
  const Place at = place(direction);
  const auto index = [](double value, std::uint32_t size) {
    return std::min(static_cast<std::size_t>(value), static_cast<std::size_t>(size) - 1);
  };
  const std::size_t row = index(at.row, map_.height);
  return chance(row * map_.width + index(at.column, map_.width)) / solid_angle(row);
}

}  // namespace qtrace::independent
