#pragma once

#include <span>
#include <string_view>

namespace qtrace::gpu {

struct EmbeddedShader {
  std::string_view name;
  std::string_view text;
};

// All files of shaders/, as they were when this program was built (written by cmake/embed_shaders.cmake).
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace qtrace::gpu
