// Visitors over declared knobs (engine/core/knob.h): read them from JSON, write them, list them.
#pragma once

#include "experiments/config/knob_type.h"

#include <algorithm>
#include <string>
#include <vector>

namespace qtrace::experiments {

// One line of the table of keys.
struct KeyRow {
  std::string key;  // dotted
  std::string type;
  std::string default_value;
  std::string unit;
  std::string help;
};

namespace detail {
struct AnyVisitor {
  template <class T>
  void operator()(const KnobInfo&, T&) const {}
};
}  // namespace detail

// A struct whose members are knobs: it has a visit_knobs() of its own.
template <class T>
concept KnobGroup = std::is_class_v<T> && requires(detail::AnyVisitor& visit, T& group) {
  visit_knobs(visit, group);
};

template <KnobGroup T>
void read_knobs(const Json& json, T& group, const std::string& path = "");
enum class Written;
template <KnobGroup T>
Json write_knobs(T group, Written what);
template <KnobGroup T>
Json write_knobs(T group);
template <KnobGroup T>
std::vector<KeyRow> list_knobs(T group, const std::string& path = "");

inline std::string join_path(const std::string& path, std::string_view name) {
  return path.empty() ? std::string(name) : path + '.' + std::string(name);
}

// Every key that may be written in place of `rows`' leaves: the leaves and the groups around them.
inline std::vector<std::string> settable_keys(const std::vector<KeyRow>& rows) {
  std::vector<std::string> keys;
  for (const KeyRow& row : rows) {
    const std::size_t dot = row.key.find('.');
    const std::string group = row.key.substr(0, dot);
    if (dot != std::string::npos && std::find(keys.begin(), keys.end(), group) == keys.end()) {
      keys.push_back(group);
    }
    keys.push_back(row.key);
  }
  return keys;
}

class KnobReader {
 public:
  KnobReader(const Json& object, std::string path) : object_(object), path_(std::move(path)) {}

  template <class T>
  void operator()(const KnobInfo& info, T& value) {
    seen_.emplace_back(info.name);
    const auto found = object_.find(std::string(info.name));
    if (found == object_.end()) return;
    const std::string path = join_path(path_, info.name);
    if constexpr (KnobGroup<T>) {
      read_knobs(*found, value, path);
    } else {
      KnobType<T>::read(*found, info, path, value);
    }
  }

  // Throws Error at the first key that no knob was declared for; `keys` lists the ones to suggest from, and
  // is asked only then, because a sweep reads many thousand configs.
  template <class Keys>
  void reject_unknown(const Keys& keys) const {
    for (const auto& [key, value] : object_.items()) {
      if (std::find(seen_.begin(), seen_.end(), key) != seen_.end()) continue;
      const std::string path = join_path(path_, key);
      const std::string hint = suggestion(path, keys());
      fail("unknown key '{}'{}", path, hint.empty() ? "; `qtrace keys` lists all keys" : hint);
    }
  }

 private:
  const Json& object_;
  std::string path_;
  std::vector<std::string> seen_;
};

// What is written: every knob, or what identifies their values for hashes that must stand still while knobs
// are added (KnobInfo::implied).
enum class Written { all, identity };

class KnobWriter {
 public:
  explicit KnobWriter(Written what) : what_(what) {}

  template <class T>
  void operator()(const KnobInfo& info, T& value) {
    const std::string name(info.name);
    if constexpr (KnobGroup<T>) {
      Json group = write_knobs(value, what_);
      // A group whose knobs all came later and are as before leaves no trace, either.
      if (what_ == Written::all || !group.empty()) object[name] = std::move(group);
    } else {
      Json written = KnobType<T>::write(value);
      if (what_ == Written::all || info.implied.empty() || written != Json::parse(info.implied))
        object[name] = std::move(written);
    }
  }
  Json object = Json::object();

 private:
  Written what_;
};

class KnobLister {
 public:
  explicit KnobLister(std::string path) : path_(std::move(path)) {}

  template <class T>
  void operator()(const KnobInfo& info, T& value) {
    const std::string key = join_path(path_, info.name);
    if constexpr (KnobGroup<T>) {
      for (KeyRow& row : list_knobs(value, key)) rows.push_back(std::move(row));
    } else {
      rows.push_back({key, KnobType<T>::describe(info), show(KnobType<T>::write(value)),
                      std::string(info.unit), std::string(info.help)});
    }
  }
  std::vector<KeyRow> rows;

 private:
  std::string path_;
};

// Sets the knobs that `json` names and leaves the others as they are. Throws Error that names the key:
// unknown (with the nearest known one), wrong type, out of range.
template <KnobGroup T>
void read_knobs(const Json& json, T& group, const std::string& path) {
  if (!json.is_object()) {
    if (path.empty()) fail("a config must be a JSON object, not {}", show(json));
    reject_value(path, json, "an object");
  }
  KnobReader reader(json, path);
  visit_knobs(reader, group);
  reader.reject_unknown([&] { return settable_keys(list_knobs(T{}, path)); });
}

// The knobs of a group as a JSON object, in the order of their declaration.
template <KnobGroup T>
Json write_knobs(T group, Written what) {
  KnobWriter writer(what);
  visit_knobs(writer, group);
  return writer.object;
}

template <KnobGroup T>
Json write_knobs(T group) {
  return write_knobs(std::move(group), Written::all);
}

// One row per knob, nested ones with dotted keys; the values are those of `group`.
template <KnobGroup T>
std::vector<KeyRow> list_knobs(T group, const std::string& path) {
  KnobLister lister(path);
  visit_knobs(lister, group);
  return lister.rows;
}

}  // namespace qtrace::experiments
