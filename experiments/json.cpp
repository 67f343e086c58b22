#include "experiments/json.h"

#include "engine/core/check.h"
#include "engine/core/text.h"
#include "experiments/atomic_file.h"

#include <set>

namespace qtrace::experiments {
namespace {

constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxKeys = 4096;  // in one object; ordered_json looks through all for each
constexpr std::size_t kMaxShown = 60;   // characters of a value in a message

// nlohmann's texts start with "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
std::string without_tag(const std::string& message) {
  const std::size_t end = message.find("] ");
  return message.starts_with('[') && end != std::string::npos ? message.substr(end + 2) : message;
}

// Sees every key while parsing, because the parsed object has forgotten the first of two equal keys.
class KeyWatch {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    check(depth <= kMaxDepth, "values are nested more than {} deep", kMaxDepth);
    if (event == Json::parse_event_t::object_start) open_.emplace_back();
    if (event == Json::parse_event_t::object_end) open_.pop_back();
    if (event == Json::parse_event_t::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      check(open_.back().insert(key).second, "key '{}' stands twice in one object; keep one of them", key);
      check(open_.back().size() <= kMaxKeys, "an object has more than {} keys; divide it", kMaxKeys);
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> open_;
};

void add_leaf_paths(const Json& object, const std::string& prefix, std::vector<std::string>& paths) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object() && !value.empty()) {
      add_leaf_paths(value, prefix + key + '.', paths);
    } else {
      paths.push_back(prefix + key);
    }
  }
}

}  // namespace

Json parse_json(const std::string& text) {
  KeyWatch watch;
  try {
    const auto callback = [&watch](int depth, Json::parse_event_t event, Json& parsed) {
      return watch(depth, event, parsed);
    };
    return Json::parse(text, callback, true, true);
  } catch (const Json::exception& error) {
    fail("not valid JSON: {}", without_tag(error.what()));
  }
}

Json read_json_file(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    return parse_json(text);
  } catch (const Error& error) {
    fail("{}: {}", file.string(), error.what());
  }
}

std::string show(const Json& value, bool bare) {
  if (bare && value.is_string()) return value.get<std::string>();
  const std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return bare ? text : shortened(text, kMaxShown);
}

void set_path(Json& object, std::string_view path, const Json& value) {
  Json* place = &object;
  std::string_view rest = path;
  for (std::size_t dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
    Json& next = (*place)[std::string(rest.substr(0, dot))];
    if (next.is_null()) next = Json::object();
    check(next.is_object(), "key '{}' is {} but must be an object, because '{}' is set too",
          path.substr(0, path.size() - rest.size() + dot), show(next), path);
    place = &next;
    rest.remove_prefix(dot + 1);
  }
  Json& target = (*place)[std::string(rest)];
  if (target.is_object() && value.is_object()) {
    merge(target, value);
  } else {
    target = value;
  }
}

void merge(Json& object, const Json& overrides) {
  for (const auto& [key, value] : overrides.items()) set_path(object, key, value);
}

std::vector<std::string> leaf_paths(const Json& object) {
  std::vector<std::string> paths;
  add_leaf_paths(object, "", paths);
  return paths;
}

bool paths_overlap(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) return paths_overlap(b, a);
  return b.starts_with(a) && (a.size() == b.size() || b[a.size()] == '.');
}

std::string canonical_text(const Json& value) { return nlohmann::json(value).dump(); }

}  // namespace qtrace::experiments
