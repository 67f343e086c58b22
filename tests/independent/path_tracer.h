// An independent check of the renderer: a path tracer on the CPU in double precision. It takes the scene's
// plain data and shares no code with the engine or its shaders: its own intersection, materials, light
// samples, random numbers. To be read in ten minutes: path_tracer.cpp follows paths. bvh.cpp finds hits, and
// surface.cpp what is there, with texture.cpp and shading_normal.cpp. material.cpp is glTF's appendix B with
// its extensions, and scattering.cpp draws directions by it. lights.cpp and environment.cpp are what shines.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace qtrace::independent {

struct Options {
  int width = 64;
  int height = 64;
  int max_bounces = 5;  // scattering events; no Russian roulette
  int samples = 64;     // per pixel
  std::uint64_t seed = 1;
  glm::dvec3 environment{0};  // radiance from outside of a scene that has no image of it; paths run into it
  // Light samples beside the emission that paths run into, each weighted by its share of both densities. Only
  // they find punctual lights.
  bool sample_lights = true;
};

struct Image {
  std::vector<glm::dvec3> mean;      // radiance, row by row from the top
  std::vector<glm::dvec3> variance;  // of that mean
};

Image trace(const Scene& scene, const Options& options);

// Whether the camera sees different emission in parts of a pixel (1, row by row from the top; else 0), by a
// lattice of rays.
std::vector<char> edges_of_lights(const Scene& scene, const Options& options);

}  // namespace qtrace::independent
