#include "engine/gltf_document/buffer.h"

#include "engine/gltf_document/usage.h"

#include <algorithm>
#include <charconv>
#include <system_error>

namespace qtrace::gltf {
namespace {

namespace fs = std::filesystem;

std::string percent_decoded(std::string_view uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char code = 0;
    const char* digits = uri.data() + i + 1;
    const bool is_escape = uri[i] == '%' && i + 2 < uri.size() &&
                           std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    path += is_escape ? static_cast<char>(code) : uri[i];
    if (is_escape) i += 2;
  }
  return path;
}

// A scene must not read files that are none of its business, whatever its author wrote.
fs::path resolve(const Source& source, const std::string& buffer, const std::string& uri,
                 const fs::path& folder) {
  const std::string decoded = percent_decoded(uri);
  source.check(decoded.find("://") == std::string::npos && decoded.find('\0') == std::string::npos,
               "{}: '{}' is not the path of a file; a relative path would be right", buffer, uri);
  const fs::path relative(decoded);
  source.check(relative.is_relative(), "{}: '{}' is an absolute path; a relative path would be right", buffer,
               uri);
  std::error_code folder_error;
  std::error_code file_error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, folder_error);
  const fs::path file = fs::weakly_canonical(root / relative, file_error);
  source.check(!folder_error && !file_error, "{}: '{}' cannot be resolved", buffer, uri);
  const fs::path inside = file.lexically_relative(root);
  source.check(!inside.empty() && *inside.begin() != "..",
               "{}: '{}' leaves the scene's folder; a file inside it would be right", buffer, uri);
  return file;
}

// tinygltf decodes none but these media types. The bytes of others are no different.
std::vector<unsigned char> decode_data_uri(Source& source, const std::string& buffer, std::string uri) {
  constexpr std::string_view kRight = "data:application/octet-stream;base64,", kEnd = ";base64,";
  const std::string begin = uri.substr(0, std::min<std::size_t>(uri.find(','), 60));
  if (!tinygltf::IsDataURI(uri)) {
    const std::size_t end = uri.find(kEnd);
    source.check(end != std::string::npos, "{}: the data URI begins with '{}'; {} would be right", buffer,
                 begin, kRight);
    source.warn("{}: the data URI begins with '{}', where glTF has {}; its bytes are read all the same",
                buffer, begin, kRight);
    uri.replace(0, end + kEnd.size(), kRight);
  }
  std::vector<unsigned char> bytes;
  std::string mime_type;
  const bool is_decoded = tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false);
  source.check(is_decoded, "{}: the data URI is empty or not base64", buffer);
  return bytes;
}

void check_length(const Source& source, const std::string& buffer, std::size_t found, std::size_t declared) {
  source.check(found >= declared, "{}: byteLength declares {} bytes and there are {}", buffer, declared,
               found);
}

std::vector<unsigned char> load(Source& source, const std::string& buffer, const std::string& uri,
                                std::size_t size, const fs::path& folder) {
  if (!uri.starts_with("data:")) {
    const fs::path file = resolve(source, buffer, uri, folder);
    const std::string what = fmt::format("{}: {}: '{}'", source.file, buffer, uri);
    check_length(source, buffer, regular_file_size(file, what), size);
    return read_bytes(file, size, what);
  }
  std::vector<unsigned char> bytes = decode_data_uri(source, buffer, uri);
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
