#include "experiments/files/json.h"

#include "engine/core/check.h"
#include "engine/core/text.h"
#include "experiments/files/atomic_file.h"

#include <algorithm>
#include <set>

namespace qtrace::experiments {
namespace {

constexpr std::size_t kMaxDepth = 16;
constexpr std::size_t kMaxKeys = 4096;  // in one object; ordered_json looks through all for each
constexpr std::size_t kMaxShown = 60;   // characters of a value in a message

// nlohmann's texts start with "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
std::string without_tag(const std::string& message) {
  const std::size_t end = message.find("] ");
  return message.starts_with('[') && end != std::string::npos ? message.substr(end + 2) : message;
}

// Sees every key before the parsed object has forgotten the first of two equal keys. No callback of
// Json::parse, which looks through all elements of a list after each object in it (3.11).
class KeyWatch : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& key) override {
    check(keys_.back().insert(key).second, "key '{}' stands twice in one object; keep one of them", key);
    check(keys_.back().size() <= kMaxKeys, "an object has more than {} keys; divide it", kMaxKeys);
    return true;
  }
  // Json::parse will say it.
  bool parse_error(std::size_t, const std::string&, const Json::exception&) override { return false; }

 private:
  bool open() {
    keys_.emplace_back();
    check(keys_.size() <= kMaxDepth, "values are nested more than {} deep", kMaxDepth);
    return true;
  }
  bool close() {
    keys_.pop_back();
    return true;
  }

  std::vector<std::set<std::string>> keys_;  // of all objects and lists that are open
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
  try {
    KeyWatch watch;
    Json::sax_parse(text, &watch, Json::input_format_t::json, true, true);
    return Json::parse(text, nullptr, true, true);
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
  const auto parts = static_cast<std::size_t>(std::ranges::count(path, '.')) + 1;
  check(parts <= kMaxDepth, "key '{}' has {} parts; at most {} would be right", shortened(path, kMaxShown),
        parts, kMaxDepth);
  Json* place = &object;
  std::string_view rest = path;
  for (std::size_t dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
    Json& next = (*place)[std::string(rest.substr(0, dot))];
    if (next.is_null()) next = Json::object();
    if (!next.is_object()) {  // not by check(), which would write down every object on the way
      fail("key '{}' is {} but must be an object, because '{}' is set too",
           path.substr(0, path.size() - rest.size() + dot), show(next), path);
    }
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

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void write_json(const std::filesystem::path& file, const Json& json) { write_file(file, json_text(json)); }

}  // namespace qtrace::experiments
