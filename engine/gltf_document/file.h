// The bytes of a scene file, and the two chunks of a .glb.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace qtrace::gltf {

struct FileContent {
  std::string json;
  bool has_binary = false;
  std::vector<unsigned char> binary;  // the BIN chunk of a .glb
};

// Bytes are a .glb if they begin with that format's magic number, and JSON otherwise.
FileContent split_content(std::span<const unsigned char> bytes, const std::filesystem::path& file);

// The whole file.
std::vector<unsigned char> read_scene_file(const std::filesystem::path& file);

// The size of a regular file; Error names `what` where there is none.
std::size_t regular_file_size(const std::filesystem::path& file, const std::string& what);

// The first `size` bytes; Error names `what` where the file has fewer or cannot be read.
std::vector<unsigned char> read_bytes(const std::filesystem::path& file, std::size_t size,
                                      const std::string& what);

}  // namespace qtrace::gltf
