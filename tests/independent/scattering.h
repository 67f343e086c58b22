// Directions at a point: drawn by one of several techniques, with the density that all of them have together.
#pragma once

#include "tests/independent/material.h"
#include "tests/independent/random.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

namespace qtrace::independent {

class Scattering {
 public:
  explicit Scattering(const Point& p);

  struct Sample {
    glm::dvec3 direction{0};
    glm::dvec3 weight{0};  // of the radiance from there; black: the path ends
    double density = 0;    // per steradian; infinite: of a smooth lobe, which nothing else samples
  };
  Sample sample(Random& random) const;

  // With which sample() draws a direction from lobes that have more than one.
  double density(const glm::dvec3& direction) const;

 private:
  enum Technique : std::size_t { kCosineAbove, kReflection, kTransmission, kCosineBelow, kCoat };
  static constexpr std::size_t kTechniques = 5;

  Technique choose(double random) const;
  glm::dvec3 draw(Technique technique, Random& random) const;  // zero where that fails
  double density(Technique technique, const glm::dvec3& direction) const;
  bool has_one_direction(Technique technique) const;

  const Point& p_;
  std::array<double, kTechniques> chances_{};
};

}  // namespace qtrace::independent
