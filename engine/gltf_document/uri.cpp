#include "engine/gltf_document/uri.h"

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

}  // namespace

fs::path resolve_uri(const Source& source, const std::string& what, const std::string& uri,
                     const fs::path& folder) {
  const std::string decoded = percent_decoded(uri);
  source.check(decoded.find("://") == std::string::npos && decoded.find('\0') == std::string::npos,
               "{}: '{}' is not the path of a file; a relative path would be right", what, uri);
  const fs::path relative(decoded);
  source.check(relative.is_relative(), "{}: '{}' is an absolute path; a relative path would be right", what,
               uri);
  std::error_code folder_error;
  std::error_code file_error;
  const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, folder_error);
  const fs::path file = fs::weakly_canonical(root / relative, file_error);
  source.check(!folder_error && !file_error, "{}: '{}' cannot be resolved", what, uri);
  const fs::path inside = file.lexically_relative(root);
  source.check(!inside.empty() && *inside.begin() != "..",
               "{}: '{}' leaves the scene's folder; a file inside it would be right", what, uri);
  return file;
}

// tinygltf decodes none but a few media types. The bytes of others are no different.
std::vector<unsigned char> decode_data_uri(Source& source, const std::string& what, std::string uri,
                                           std::string_view right) {
  constexpr std::string_view kEnd = ";base64,";
  const std::string begin = uri.substr(0, std::min<std::size_t>(uri.find(','), 60));
  if (!tinygltf::IsDataURI(uri)) {
    const std::size_t end = uri.find(kEnd);
    source.check(end != std::string::npos, "{}: the data URI begins with '{}'; {} would be right", what,
                 begin, right);
    source.warn("{}: the data URI begins with '{}', where glTF has {}; its bytes are read all the same", what,
                begin, right);
    uri.replace(0, end + kEnd.size(), "data:application/octet-stream;base64,");
  }
  std::vector<unsigned char> bytes;
  std::string mime_type;
  const bool is_decoded = tinygltf::DecodeDataURI(&bytes, mime_type, uri, 0, false);
  source.check(is_decoded, "{}: the data URI is empty or not base64", what);
  return bytes;
}

}  // namespace qtrace::gltf
