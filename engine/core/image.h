// Plain images on the host, row 0 at the top, pixel (x, y) at index y * width + x.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace qtrace {

// An estimate of radiance per pixel: the mean over `samples` frames and the variance *of that mean*
// (sample variance / samples; 0 where samples < 2). Linear Rec. 709 RGB, double precision.
struct RadianceImage {
  int width = 0;
  int height = 0;
  std::uint64_t samples = 0;
  std::vector<glm::dvec3> mean;
  std::vector<glm::dvec3> variance;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

// What the ray through each pixel's centre meets first; all zero where it leaves the scene.
struct FirstHitImage {
  int width = 0;
  int height = 0;
  std::vector<glm::vec3> normal;    // unit shading normal, towards the camera
  std::vector<glm::vec3> position;  // world space
  std::vector<glm::vec3> albedo;    // base colour
  std::vector<glm::vec3> emission;  // radiance that it emits towards the camera
};

}  // namespace qtrace
