// Scenes of a few surfaces, and the radiance that one ray finds in them.
#pragma once

#include "engine/scene/analytic.h"
#include "tests/independent/path_tracer.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace qtrace::independent {

inline constexpr float kNarrow = 1e-7F;  // radians: the picture is one point
inline constexpr double kExact = 1e-6;   // relative: positions and materials are floats
inline constexpr double kSigmas = 4;     // of a seed that is fixed

inline Options one_pixel(int max_bounces, int samples = 1) {
  Options options;
  options.width = options.height = 1;
  options.max_bounces = max_bounces;
  options.samples = samples;
  return options;
}

struct Seen {
  glm::dvec3 mean, error;  // standard error
};

inline Seen seen_from(Scene scene, glm::vec3 eye, glm::vec3 target, const Options& options) {
  scene.camera = look_at(eye, target, kNarrow);
  const Image image = trace(scene, options);
  return {image.mean[0], glm::sqrt(image.variance[0])};
}

inline void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance = kExact) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(found[k], expected[k], tolerance * std::max(1.0, std::abs(expected[k]))) << "channel " << k;
  }
}

// By chance alone; the error must be small as well.
inline void expect_about(const Seen& found, const glm::dvec3& expected, double largest_error = 0.01) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(found.mean[k], expected[k], kSigmas * found.error[k] + kExact) << "channel " << k;
    EXPECT_LE(found.error[k], largest_error * expected[k]) << "channel " << k;
  }
}

// The square of side 2 about the z axis at this z, its front towards +z, its UV map the unit square.
inline void add_wall(Scene& scene, float z, const Material& material) {
  scene.materials.push_back(material);
  add_quad(scene, {-1, -1, z}, {2, 0, 0}, {0, 2, 0}, static_cast<std::uint32_t>(scene.materials.size() - 1));
}
inline Scene wall(const Material& material) {
  Scene scene;
  add_wall(scene, 0, material);
  return scene;
}

// Of all triangles, the same at all corners.
inline void set_attributes(Scene& scene, const TriangleAttributes& attributes) {
  scene.attributes = {attributes};
  for (Triangle& triangle : scene.triangles) triangle.attributes = 0;
}

// An image of 8 bits per value, row by row.
using Rgba = std::array<std::uint8_t, 4>;
inline Texture add_image(Scene& scene, std::uint32_t width, const std::vector<Rgba>& texels) {
  TextureImage image{"image", width, static_cast<std::uint32_t>(texels.size()) / width, {}};
  for (const Rgba& texel : texels) {
    TextureImage::Texel& stored = image.texels.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) stored[k] = static_cast<std::uint16_t>(257 * texel[k]);
  }
  scene.images.push_back(image);
  Texture texture;
  texture.image = static_cast<std::uint32_t>(scene.images.size() - 1);
  return texture;
}

inline Material unlit(glm::vec3 color) {
  Material m = lambert(color);
  m.is_unlit = true;
  return m;
}

inline Material emitter(glm::vec3 radiance) { return lambert(glm::vec3(0), radiance); }

// A dielectric without a diffuse part.
inline Material glass(float roughness, bool is_thin, float ior = 1.5F) {
  Material m;
  m.metallic = 0;
  m.roughness = roughness;
  m.transmission = 1;
  m.is_thin = is_thin;
  m.ior = ior;
  return m;
}

inline PunctualLight sun(glm::vec3 direction, glm::vec3 irradiance) {
  PunctualLight light;
  light.kind = PunctualLight::Kind::directional;
  light.direction = glm::normalize(direction);
  light.intensity = irradiance;
  return light;
}

}  // namespace qtrace::independent
