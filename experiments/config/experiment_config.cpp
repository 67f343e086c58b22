#include "experiments/config/experiment_config.h"

#include "engine/core/check.h"
#include "engine/core/text.h"
#include "experiments/files/atomic_file.h"

#include <algorithm>
#include <set>

namespace qtrace::experiments {
namespace {

struct Setting {
  std::string key;
  Json value;
};

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  check(equals != std::string::npos && equals > 0, "--set {}: must be key=value", text);
  Setting setting{text.substr(0, equals), text.substr(equals + 1)};
  try {
    setting.value = parse_json(text.substr(equals + 1));
  } catch (const Error&) {
    // Not JSON, so it stays the text that it is: --set sampler=rl needs no quotes.
  }
  return setting;
}

// Replaces the values of the axis that "sweep.AXIS" names.
void set_axis(Json& config, const Setting& setting) {
  const std::string name = setting.key.substr(std::string("sweep.").size());
  std::vector<std::string> names;
  if (config.contains("sweep") && config["sweep"].is_array()) {
    for (Json& axis : config["sweep"]) {
      if (!axis.is_object() || axis.size() != 1) continue;
      names.push_back(axis.begin().key());
      if (names.back() == name) {
        axis.begin().value() = setting.value;
        return;
      }
    }
  }
  fail("--set {}: the sweep has no axis '{}'{}", setting.key, name, suggestion(name, names));
}

void apply_setting(Json& config, const Setting& setting) {
  if (setting.key.starts_with("sweep.")) return set_axis(config, setting);
  const std::vector<std::string> keys = settable_keys(list_knobs(ExperimentKeys{}));
  check(std::find(keys.begin(), keys.end(), setting.key) != keys.end(), "--set: unknown key '{}'{}",
        setting.key, suggestion(setting.key, keys));
  set_path(config, setting.key, setting.value);
}

void check_not_swept(const Setting& setting, const std::vector<Axis>& axes) {
  for (const Axis& axis : axes) {
    for (const AxisValue& value : axis.values) {
      for (const std::string& path : leaf_paths(value.overrides)) {
        check(!paths_overlap(setting.key, path),
              "--set {}: the sweep axis '{}' sets '{}' too; use --set 'sweep.{}=...' to give that axis other "
              "values",
              setting.key, axis.name, path, axis.name);
      }
    }
  }
}

// Keys may be dotted in the file as well; the same key twice is an error in any spelling.
Json nested(const Json& raw) {
  if (!raw.is_object()) return raw;  // refused by the reader
  std::set<std::string> paths;
  for (const std::string& path : leaf_paths(raw)) {
    check(paths.insert(path).second, "key '{}' is given twice, nested and dotted; keep one", path);
  }
  Json config = Json::object();
  merge(config, raw);
  return config;
}

// "$schema" names a JSON Schema to editors and means nothing to a run.
void drop_schema(Json& config) {
  if (!config.is_object() || !config.contains("$schema")) return;
  const Json& schema = config["$schema"];
  check(schema.is_string(), "key '$schema' is {} but must be a text: where an editor finds the schema",
        show(schema));
  config.erase("$schema");
}

Json read_preset(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 20U;
  check(is_file(file), "there is no such file; it is looked for in the config's folder");
  check(std::filesystem::file_size(file) <= kMostBytes, "the preset has {} bytes; at most {} would be right",
        std::filesystem::file_size(file), kMostBytes);
  const Json raw = read_json_file(file);
  check(raw.is_object(), "must hold one JSON object");
  Json preset = Json::object();
  merge(preset, raw);
  for (const char* own : {"name", "scene"}) {
    check(!preset.contains(own), "sets '{}', which belongs to a config", own);
  }
  RunConfig run;
  read_knobs(preset, run);  // refuses what no run has, other presets and sweeps among it
  return preset;
}

// `config` over the settings of the file that its key 'preset' names, relative to `file`, the config's own
// place; as it is where it names none. Throws Error that names the preset's file.
Json with_preset(const Json& config, const std::filesystem::path& file) {
  if (!config.is_object() || !config.contains("preset") || !config["preset"].is_string()) return config;
  const std::string name = config["preset"].get<std::string>();
  if (name.empty()) return config;
  Json result;
  try {
    result = read_preset(file.parent_path() / name);
  } catch (const Error& error) {
    fail("preset {}: {}", show(config["preset"]), error.what());
  }
  merge(result, config);
  return result;
}

Run make_run(const SweepPoint& point, const RunConfig& base) {
  Run run{point.id, point.configuration, point.labels, base};
  try {
    read_knobs(point.overrides, run.config);
    check_run_config(run.config);
  } catch (const Error& error) {
    fail("run '{}': {}", point.id, error.what());
  }
  return run;
}

void check_published(Experiment& experiment) {
  constexpr std::size_t kMostWarnings = 10;
  std::set<std::string> configurations;
  std::set<std::string> labels;
  for (const Run& run : experiment.runs) {
    configurations.insert(run.configuration);
    labels.insert(run.labels.begin(), run.labels.end());
  }
  std::size_t unknown = 0;
  const auto warn = [&](const std::string& names, const std::string& hint) {
    experiment.warnings.push_back(fmt::format(
        "{}: {}", experiment.file.string(),
        one_line(fmt::format("'published' names {}, which the sweep does not have{}", names, hint))));
  };
  const auto warn_unless_known = [&](const std::string& name, const std::set<std::string>& known) {
    if (name.empty() || known.contains(name) || ++unknown > kMostWarnings) return;
    warn(fmt::format("'{}'", name), suggestion(name, {known.begin(), known.end()}));
  };
  for (const auto& [configuration, ms] : experiment.published.ms_per_frame.by_configuration)
    warn_unless_known(configuration, configurations);
  for (const std::string& label : experiment.published.ratio) warn_unless_known(label, labels);
  if (unknown > kMostWarnings) warn(fmt::format("{} more", unknown - kMostWarnings), "");
}

// A label must belong to one axis alone, so that it is clear which one is compared along.
void check_baseline(const Experiment& experiment) {
  if (experiment.baseline.empty()) return;
  std::vector<std::string> names;
  int axes = 0;
  for (const Axis& axis : experiment.axes) {
    if (axis.is_seed) continue;
    for (const AxisValue& value : axis.values) names.push_back(value.label);
    axes += std::ranges::count(axis.values, experiment.baseline, &AxisValue::label) > 0 ? 1 : 0;
  }
  check(axes < 2, "key 'baseline' is '{}', a label of {} axes; name a whole configuration instead",
        experiment.baseline, axes);
  for (const Run& run : experiment.runs) {
    if (names.empty() || names.back() != run.configuration)
      names.push_back(run.configuration);  // seeds follow each other
  }
  check(std::ranges::find(names, experiment.baseline) != names.end(),
        "key 'baseline' is '{}' but must be a label or a configuration of the sweep{}", experiment.baseline,
        suggestion(experiment.baseline, names));
}

Experiment build(const std::string& text, const std::filesystem::path& file,
                 const std::vector<std::string>& sets, const SweepLimits& limits) {
  constexpr std::size_t kMaxText = std::size_t{1} << 20U;
  check(text.size() <= kMaxText, "the config has {} bytes; at most {} would be right", text.size(), kMaxText);
  Experiment experiment;
  experiment.file = file;
  experiment.config = nested(parse_json(text));
  drop_schema(experiment.config);
  std::vector<Setting> settings;
  for (const std::string& set : sets) settings.push_back(parse_setting(set));
  if (experiment.config.is_object()) {
    for (const Setting& setting : settings) apply_setting(experiment.config, setting);
  }

  experiment.config = with_preset(experiment.config, file);
  ExperimentKeys keys;
  read_knobs(experiment.config, keys);
  for (const Setting& setting : settings) check_not_swept(setting, keys.sweep.axes);
  experiment.name = keys.run.name;
  experiment.axes = keys.sweep.axes;
  experiment.published = keys.published;
  experiment.baseline = keys.baseline;

  Json base = experiment.config;
  for (const char* once : {"sweep", "published", "baseline", "preset"}) base.erase(once);
  check_size(keys.sweep, base.dump().size(), limits);
  expand_sweep(keys.sweep,
               [&](const SweepPoint& point) { experiment.runs.push_back(make_run(point, keys.run)); });
  check_published(experiment);
  check_baseline(experiment);
  return experiment;
}

}  // namespace

const double* PublishedTimes::find(const std::string& configuration) const {
  for (const auto& [name, ms] : by_configuration) {
    if (name == configuration) return &ms;
  }
  return nullptr;
}

std::string KnobType<PublishedTimes>::describe(const KnobInfo&) {
  return "an object of configurations and positive numbers";
}

void KnobType<PublishedTimes>::read(const Json& json, const KnobInfo& info, const std::string& path,
                                    PublishedTimes& times) {
  if (!json.is_object()) reject_value(path, json, describe(info));
  times.by_configuration.clear();
  for (const auto& [configuration, value] : json.items()) {
    double ms = 0;
    KnobType<double>::read(value, info, path + '.' + configuration, ms);
    check(ms > 0, "key '{}.{}' is {} but must be a positive number", path, configuration, ms);
    times.by_configuration.emplace_back(configuration, ms);
  }
}

Json KnobType<PublishedTimes>::schema(const KnobInfo&) {
  return {{"type", "object"}, {"additionalProperties", {{"type", "number"}, {"exclusiveMinimum", 0}}}};
}

Json KnobType<PublishedTimes>::write(const PublishedTimes& times) {
  Json json = Json::object();
  for (const auto& [configuration, ms] : times.by_configuration) json[configuration] = ms;
  return json;
}

std::optional<EnvironmentImage> Experiment::environment_image(const Run& run) const {
  std::optional<EnvironmentImage> image = run.config.environment_image;
  if (image) image->file = (folder() / image->file).string();
  return image;
}

Experiment load_experiment(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  return parse_experiment(read_file(file), file, sets);
}

Experiment parse_experiment(const std::string& text, const std::filesystem::path& file,
                            const std::vector<std::string>& sets, const SweepLimits& limits) {
  try {
    return build(text, file, sets, limits);
  } catch (const Error& error) {
    const std::string message = one_line(error.what());
    if (message.starts_with("--set")) fail("{}", message);
    fail("{}: {}", file.string(), message);
  }
}

}  // namespace qtrace::experiments
