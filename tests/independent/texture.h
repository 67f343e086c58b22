// Look-ups in images.
#pragma once

#include "engine/scene/scene.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace qtrace::independent {

// The image's value at coordinates of the triangle's set, linear: RGB of slots in sRGB is decoded.
glm::dvec4 look_up(const Scene& scene, const Texture& texture, TextureSlot slot, const glm::dvec2& uv);

}  // namespace qtrace::independent
