#include "experiments/records/record_json.h"

#include "engine/core/check.h"

namespace qtrace::experiments {
namespace {

// Members in a fixed order; raised where that changes.
constexpr int kLayout = 5;

template <class Visitor>
void visit_fields(Visitor& visit, FrameCounters& s) {
  visit(s.paths), visit(s.rays), visit(s.path_segments), visit(s.zero_paths), visit(s.cell_lookups);
  visit(s.cell_fallbacks), visit(s.non_finite), visit(s.table_updates), visit(s.saturated_updates);
  visit(s.fireflies), visit(s.clamped_samples), visit(s.light_rays), visit(s.splats);
  visit(s.connections);
}

template <class Visitor>
void visit_fields(Visitor& visit, FrameRecord& frame) {
  visit(frame.frame), visit(frame.is_warmup), visit(frame.host_ms), visit(frame.gpu_ms);
  visit(frame.elapsed_s), visit(frame.gpu_elapsed_s), visit(frame.counters);
}

template <class Visitor>
void visit_fields(Visitor& visit, ReferenceNoise& noise) {
  visit(noise.mse), visit(noise.relmse);
}

template <class Visitor>
void visit_fields(Visitor& visit, ErrorMetrics& e) {
  for (const Metric& metric : error_metrics()) {
    std::visit(
        [&](const auto& member) {
          // What is computed from other members is not kept.
          if constexpr (std::is_member_object_pointer_v<std::decay_t<decltype(member)>>) visit(e.*member);
        },
        metric.member);
  }
  visit(e.reference);
}

template <class Visitor>
void visit_fields(Visitor& visit, FilteredRecord& filtered) {
  visit(filtered.errors), visit(filtered.filter_ms);
}

template <class Visitor>
void visit_fields(Visitor& visit, SnapshotRecord& snapshot) {
  visit(snapshot.frame), visit(snapshot.elapsed_s), visit(snapshot.gpu_elapsed_s), visit(snapshot.errors);
  visit(snapshot.non_finite), visit(snapshot.clamped_samples), visit(snapshot.clamp_bias);
  visit(snapshot.filtered);
}

template <class Visitor>
void visit_fields(Visitor& visit, FireflyRecord& fireflies) {
  visit(fireflies.energy_fraction), visit(fireflies.brightest);
}

template <class Visitor>
void visit_fields(Visitor& visit, Verdict& verdict) {
  visit(verdict.word), visit(verdict.reason), visit(verdict.mean), visit(verdict.mean_error);
  visit(verdict.expected), visit(verdict.worst_z);
}

template <class Visitor>
void visit_fields(Visitor& visit, RunRecord& record) {
  visit(record.scene), visit(record.status), visit(record.reason), visit(record.started);
  visit(record.reference_hash), visit(record.config_hash), visit(record.setup_s), visit(record.frames);
  visit(record.snapshots), visit(record.fireflies), visit(record.verdict);
  visit(record.table_given_up), visit(record.light_paths_given_up);
}

template <class T>
constexpr bool is_value = std::is_arithmetic_v<T> || std::is_same_v<T, std::string>;

template <class Enum>
Enum enum_of(const std::string& name) {
  const auto& names = EnumNames<Enum>::values;
  const auto found = std::ranges::find(names, name);
  check(found != names.end(), "the record of a run has the unknown word '{}'", name);
  return static_cast<Enum>(found - names.begin());
}

// Puts members into an array one after the other.
class Packer {
 public:
  template <class T>
  void operator()(T& member) {
    array_.push_back(packed(member));
  }
  Json take() { return std::move(array_); }

  template <class T>
  static Json packed(T& value) {
    if constexpr (is_value<T>) {
      return value;
    } else if constexpr (std::is_enum_v<T>) {
      return enum_name(value);
    } else {
      Packer inner;
      visit_fields(inner, value);
      return inner.take();
    }
  }
  template <class T>
  static Json packed(std::optional<T>& value) {
    return value ? Json::array({packed(*value)}) : Json::array();
  }
  template <class T>
  static Json packed(std::vector<T>& values) {
    Json all = Json::array();
    for (T& value : values) all.push_back(packed(value));
    return all;
  }

 private:
  Json array_ = Json::array();
};

class Unpacker {
 public:
  explicit Unpacker(const Json& array) : array_(array) {}
  template <class T>
  void operator()(T& member) {
    unpack_value(array_.at(next_++), member);
  }

  template <class T>
  static void unpack_value(const Json& json, T& value) {
    if constexpr (is_value<T>) {
      json.get_to(value);
    } else if constexpr (std::is_enum_v<T>) {
      value = enum_of<T>(json.get<std::string>());
    } else {
      Unpacker inner(json);
      visit_fields(inner, value);
    }
  }
  template <class T>
  static void unpack_value(const Json& json, std::optional<T>& value) {
    value.reset();
    if (!json.empty()) unpack_value(json.at(0), value.emplace());
  }
  template <class T>
  static void unpack_value(const Json& json, std::vector<T>& values) {
    values.clear();
    values.reserve(json.size());
    for (const Json& item : json) unpack_value(item, values.emplace_back());
  }

 private:
  const Json& array_;
  std::size_t next_ = 0;
};

}  // namespace

Json pack(const RunRecord& record) {
  RunRecord copy = record;  // visitors take members that can be changed
  return {{"layout", kLayout}, {"record", Packer::packed(copy)}};
}

void unpack(const Json& json, RunRecord& record) {
  try {
    check(json.at("layout").get<int>() == kLayout, "the record has layout {} where this program reads {}",
          json.at("layout").get<int>(), kLayout);
    Unpacker::unpack_value(json.at("record"), record);
  } catch (const Json::exception& error) {
    fail("the record of a run cannot be read: {}", error.what());
  }
}

}  // namespace qtrace::experiments
