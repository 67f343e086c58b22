#include "engine/gltf_document/file.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <system_error>

namespace qtrace::gltf {
namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderSize = 12;
constexpr std::size_t kChunkHeaderSize = 8;

using Bytes = std::span<const unsigned char>;

std::uint32_t little_endian(Bytes bytes, std::size_t offset) {
  return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8U |
         static_cast<std::uint32_t>(bytes[offset + 2]) << 16U |
         static_cast<std::uint32_t>(bytes[offset + 3]) << 24U;
}

bool has_magic(Bytes bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

void check_header(Bytes bytes, const std::string& name) {
  check(bytes.size() >= kHeaderSize, "{}: the .glb is truncated at byte {}; a header has {} bytes", name,
        bytes.size(), kHeaderSize);
  const std::uint32_t version = little_endian(bytes, 4);
  check(version == kVersion, "{}: the .glb container has version {}; version {} would be right", name,
        version, kVersion);
  const std::uint32_t length = little_endian(bytes, 8);
  check(length == bytes.size(),
        "{}: the .glb is truncated or padded: its header declares {} bytes and the file has {}", name, length,
        bytes.size());
}

// Returns the end of the chunk whose header starts at `offset`.
std::size_t chunk_end(Bytes bytes, std::size_t offset, const std::string& name) {
  check(bytes.size() - offset >= kChunkHeaderSize,
        "{}: the .glb is truncated: a chunk at byte {} has no complete header", name, offset);
  const std::size_t begin = offset + kChunkHeaderSize;
  const std::uint32_t length = little_endian(bytes, offset);
  check(length <= bytes.size() - begin,
        "{}: the .glb is truncated: the chunk at byte {} declares {} bytes and the file has {} left", name,
        offset, length, bytes.size() - begin);
  return begin + length;
}

// Chunks after these two are for extensions; the format asks readers to ignore them.
FileContent split_glb(Bytes bytes, const std::string& name) {
  check_header(bytes, name);
  const auto at = [&](std::size_t offset) { return bytes.begin() + static_cast<std::ptrdiff_t>(offset); };
  const std::size_t json_end = chunk_end(bytes, kHeaderSize, name);
  check(little_endian(bytes, kHeaderSize + 4) == kJsonChunk,
        "{}: the first chunk of the .glb is not JSON; a JSON chunk would be right", name);
  FileContent content;
  content.json.assign(at(kHeaderSize + kChunkHeaderSize), at(json_end));
  if (json_end == bytes.size()) return content;
  const std::size_t binary_end = chunk_end(bytes, json_end, name);
  content.has_binary = little_endian(bytes, json_end + 4) == kBinaryChunk;
  if (content.has_binary) content.binary.assign(at(json_end + kChunkHeaderSize), at(binary_end));
  return content;
}

}  // namespace

std::size_t regular_file_size(const std::filesystem::path& file, const std::string& what) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  check(std::filesystem::exists(status), "{}: there is no such file", what);
  check(std::filesystem::is_regular_file(status), "{}: this is not a regular file", what);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  check(!error, "{}: the file cannot be read: {}", what, error.message());
  return size;
}

std::vector<unsigned char> read_bytes(const std::filesystem::path& file, std::size_t size,
                                      const std::string& what) {
  std::ifstream stream(file, std::ios::binary);
  check(stream.is_open(), "{}: the file cannot be opened for reading", what);
  std::vector<unsigned char> bytes(size);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  check(static_cast<std::size_t>(stream.gcount()) == size, "{}: only {} of {} bytes can be read", what,
        stream.gcount(), size);
  return bytes;
}

FileContent split_content(std::span<const unsigned char> bytes, const std::filesystem::path& file) {
  const std::string name = file.string();
  check(!bytes.empty(), "{}: the file is empty; a .gltf or .glb file would be right", name);
  if (has_magic(bytes)) return split_glb(bytes, name);
  check(file.extension() != ".glb", "{}: the file does not begin with '{}' as every .glb does", name, kMagic);
  FileContent content;
  content.json.assign(bytes.begin(), bytes.end());
  return content;
}

std::vector<unsigned char> read_scene_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  return read_bytes(file, regular_file_size(file, name), name);
}

}  // namespace qtrace::gltf
