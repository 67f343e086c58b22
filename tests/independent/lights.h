// Samples of the light of emitting triangles, and the light of punctual lights.
#pragma once

#include "tests/independent/bvh.h"
#include "tests/independent/random.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace qtrace::independent {

// Triangles that may emit, each by its power over the squared distance; points on it by area. Where there are
// so many that sums over all of them would take long, by their power alone, out of a table.
class AreaLights {
 public:
  explicit AreaLights(const Scene& scene);

  bool empty() const { return lights_.empty(); }

  struct Sample {
    Hit place;  // without a distance
    glm::dvec3 position{0};
    double density = 0;  // per area
  };
  Sample sample(const glm::dvec3& from, Random& random) const;

  // Per area, of drawing a point of this triangle from there; 0 of a triangle that never emits.
  double density(const glm::dvec3& from, std::uint32_t triangle) const;

 private:
  struct Light {
    std::uint32_t triangle;
    double power, area;
    glm::dvec3 middle;
  };
  double weight(const Light& light, const glm::dvec3& from) const;
  double sum_of_weights(const glm::dvec3& from) const;
  const Light& at(const glm::dvec3& from, double sum) const;  // where the sum of weights reaches this
  bool are_many() const;

  const Scene& scene_;
  std::vector<Light> lights_;
  std::vector<double> power_up_to_;       // of each light and all before
  std::vector<std::size_t> of_triangle_;  // index of its light
};

// Of a punctual light at a point, as if nothing stood between.
struct Arriving {
  glm::dvec3 to_light{0};    // unit
  double distance = 0;       // infinite for directional lights
  glm::dvec3 irradiance{0};  // on a surface that faces it
};
Arriving arriving(const PunctualLight& light, const glm::dvec3& at);

}  // namespace qtrace::independent
