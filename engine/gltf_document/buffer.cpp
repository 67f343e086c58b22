#include "engine/gltf_document/buffer.h"

#include "engine/gltf_document/uri.h"
#include "engine/gltf_document/usage.h"

namespace qtrace::gltf {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDataUri = "data:application/octet-stream;base64,";

void check_length(const Source& source, const std::string& buffer, std::size_t found, std::size_t declared) {
  source.check(found >= declared, "{}: byteLength declares {} bytes and there are {}", buffer, declared,
               found);
}

std::vector<unsigned char> load(Source& source, const std::string& buffer, const std::string& uri,
                                std::size_t size, const fs::path& folder) {
  if (!uri.starts_with("data:")) {
    const fs::path file = resolve_uri(source, buffer, uri, folder);
    const std::string what = fmt::format("{}: {}: '{}'", source.file, buffer, uri);
    check_length(source, buffer, regular_file_size(file, what), size);
    return read_bytes(file, size, what);
  }
  std::vector<unsigned char> bytes = decode_data_uri(source, buffer, uri, kDataUri);
  check_length(source, buffer, bytes.size(), size);
  bytes.resize(size);
  return bytes;
}

// Before the first is read. What lies inside the scene's own file cannot be larger than that.
void check_files(const Source& source, const nlohmann::json& buffers, const std::vector<bool>& is_read,
                 std::size_t max_bytes) {
  std::size_t rest = max_bytes;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const nlohmann::json& buffer = buffers[i];
    if (!is_read[i] || !buffer.contains("uri") ||
        buffer["uri"].get_ref<const std::string&>().starts_with("data:")) {
      continue;
    }
    const auto size = buffer["byteLength"].get<std::size_t>();
    source.check(size <= rest, "the buffers ask for more than {} bytes of files, which is the most supported",
                 max_bytes);
    rest -= size;
  }
}

}  // namespace

std::vector<tinygltf::Buffer> load_buffers(Source& source, const nlohmann::json& document,
                                           const fs::path& folder, FileContent content,
                                           std::size_t max_bytes) {
  const auto array = document.find("buffers");
  if (array == document.end()) return {};
  const std::vector<bool> is_read = buffers_that_are_read(document);
  check_files(source, *array, is_read, max_bytes);
  std::vector<tinygltf::Buffer> buffers(array->size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    if (!is_read[i]) continue;
    const nlohmann::json& json = (*array)[i];
    const auto size = json["byteLength"].get<std::size_t>();
    const std::string name = fmt::format("buffer {}", i);
    if (json.contains("uri")) {
      buffers[i].data = load(source, name, json["uri"].get<std::string>(), size, folder);
      continue;
    }
    source.check(i == 0 && content.has_binary, "{} has no uri; only buffer 0 of a .glb with a BIN chunk may",
                 name);
    check_length(source, name, content.binary.size(), size);
    content.binary.resize(size);
    buffers[i].data = std::move(content.binary);
  }
  return buffers;
}

}  // namespace qtrace::gltf
