// A square that fills an orthographic camera's picture, for looking at textures point by point.
#pragma once

#include "engine/scene/analytic.h"

#include <glm/vec2.hpp>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace qtrace::test {

inline TextureImage random_image(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
  std::mt19937 random(seed);
  TextureImage image{"random", width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const auto code = [&] { return static_cast<std::uint16_t>(random() & 0xffff); };
    image.texels.push_back({code(), code(), code(), code()});
  }
  return image;
}

inline TextureImage constant_image(const glm::vec4& value) {
  const auto code = [](float v) { return static_cast<std::uint16_t>(v * 65535.0F + 0.5F); };
  return {"constant", 1, 1, {{code(value.r), code(value.g), code(value.b), code(value.a)}}};
}

// From (0, 0, 0) to (1, 1, 0), seen from +z; its coordinates are (x, y), those of set 1 (y, x), and its
// tangent is +x. Of the Lambert material 0.
inline Scene textured_quad(const glm::vec3& emission = glm::vec3(0)) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(1), emission)};
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
  for (Triangle& t : scene.triangles) {
    TriangleAttributes attributes;
    for (std::size_t i = 0; i < 3; ++i) {
      attributes.uv1[i] = {t.uv[i].y, t.uv[i].x};
      // v grows with y here, so that the image stands upside down: up in it is -y.
      attributes.tangent[i] = {1, 0, 0, -1};
    }
    t.attributes = static_cast<std::uint32_t>(scene.attributes.size());
    scene.attributes.push_back(attributes);
  }
  scene.camera = look_at({0.5F, 0.5F, 1}, {0.5F, 0.5F, 0}, 1);
  scene.camera.film_height = 1;
  return scene;
}

inline void set_texture(Scene& scene, TextureSlot slot, TextureImage image, Texture use = {}) {
  use.image = static_cast<std::uint32_t>(scene.images.size());
  scene.images.push_back(std::move(image));
  scene.materials[0].texture(slot) = use;
}

}  // namespace qtrace::test
