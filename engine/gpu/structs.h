// The structs, bindings and constants that host and shaders share, as C++.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace qtrace::gpu {

using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;

#include "shaders/shared/structs.glsl"

}  // namespace qtrace::gpu
