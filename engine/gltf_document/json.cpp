#include "engine/gltf_document/json.h"

#include <limits>

namespace qtrace::gltf {
namespace {

// tinygltf recurses into extras and extensions; glTF itself nests no deeper than about ten.
constexpr int kMaxDepth = 64;
// tinygltf counts characters in an int.
constexpr std::size_t kMaxSize = std::numeric_limits<int>::max();

// Before the parser and not as its callback, which takes quadratic time in 3.11.
void check_depth(const Source& source, const std::string& text) {
  int depth = 0;
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') is_quoted = !is_quoted;
    if (is_quoted && c == '\\') ++i;
    if (is_quoted) continue;
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    source.check(depth <= kMaxDepth, "the JSON nests deeper than {} levels", kMaxDepth);
  }
}

void check_version(const Source& source, const nlohmann::json& document) {
  source.check(document.is_object(), "the JSON is not an object; a glTF object would be right");
  const auto asset = document.find("asset");
  const bool has_version = asset != document.end() && asset->is_object() && asset->contains("version");
  source.check(has_version, "asset.version is missing; \"2.0\" would be right");
  const nlohmann::json& version = asset->at("version");
  const bool is_right = version.is_string() && version.get<std::string>().starts_with("2.");
  source.check(is_right, "asset.version is {}; \"2.0\" would be right", version.dump());
  const nlohmann::json minimum = asset->value("minVersion", nlohmann::json("2.0"));
  source.check(minimum == "2.0", "asset.minVersion is {}; \"2.0\" would be right", minimum.dump());
}

}  // namespace

nlohmann::json parse_json(const Source& source, const std::string& text) {
  source.check(text.size() < kMaxSize, "the JSON has {} bytes; less than {} would be right", text.size(),
               kMaxSize);
  check_depth(source, text);
  try {
    nlohmann::json document = nlohmann::json::parse(text);
    check_version(source, document);
    return document;
  } catch (const nlohmann::json::exception& error) {
    const std::string reason = error.what();  // "[json.exception.parse_error.101] parse error at line ..."
    source.fail("the JSON is not valid: {}", reason.substr(reason.find(' ') + 1));
  }
}

const nlohmann::json& member(const nlohmann::json& object, std::string_view name) {
  static const nlohmann::json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

}  // namespace qtrace::gltf
