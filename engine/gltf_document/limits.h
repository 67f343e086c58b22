// How large a scene may become.
#pragma once

#include <cstddef>

namespace qtrace {

// Nodes share meshes, primitives share buffers and buffers share files, so a small file may ask for any
// number of all.
struct SceneLimits {
  std::size_t triangles = std::size_t{1} << 26U;       // 7 GB
  std::size_t primitives = std::size_t{1} << 22U;      // those that are skipped included
  std::size_t file_bytes = std::size_t{1} << 33U;      // of buffers in files of their own
  std::size_t expanded_bytes = std::size_t{1} << 32U;  // of sparse accessors and those without data
};

}  // namespace qtrace
