// How large a scene may become.
#pragma once

#include <cstddef>

namespace qtrace {

// Nodes share meshes, primitives share buffers and buffers share files, so a small file may ask for any
// number of all.
struct SceneLimits {
  std::size_t triangles = std::size_t{1} << 26U;       // 7 GB; with attributes of their own 15
  std::size_t primitives = std::size_t{1} << 22U;      // those that are skipped included
  std::size_t file_bytes = std::size_t{1} << 33U;      // of buffers in files of their own, and of images
  std::size_t expanded_bytes = std::size_t{1} << 32U;  // of sparse accessors and those without data
  std::size_t texels = std::size_t{1} << 27U;          // of all images: 1 GB
};

}  // namespace qtrace
