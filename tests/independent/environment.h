// Radiance from outside of the scene, out of an image, and samples of it.
#pragma once

#include "engine/scene/lights.h"
#include "tests/independent/random.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace qtrace::independent {

class Environment {
 public:
  explicit Environment(const EnvironmentMap& map);

  glm::dvec3 radiance(const glm::dvec3& direction) const;

  // A texel, by the brightest radiance near it and its solid angle; directions uniform within.
  struct Sample {
    glm::dvec3 direction{0};
    double density = 0;  // per steradian
  };
  Sample sample(Random& random) const;
  double density(const glm::dvec3& direction) const;

 private:
  struct Place {
    double column, row;  // in texels from the upper left corner
  };
  Place place(const glm::dvec3& direction) const;
  glm::dvec3 direction(double column, double cosine) const;
  glm::dvec3 texel(std::ptrdiff_t column, std::ptrdiff_t row) const;
  double solid_angle(std::size_t row) const;  // of one of its texels
  double chance(std::size_t texel) const { return up_to_[texel + 1] - up_to_[texel]; }

  const EnvironmentMap& map_;
  std::vector<double> up_to_;  // chance of all texels before; one more at the end, 1
};

}  // namespace qtrace::independent
