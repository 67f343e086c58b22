#include "experiments/config/preset.h"

#include "engine/core/check.h"
#include "experiments/config/config.h"

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

Json read_preset(const fs::path& file) {
  constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 20U;
  check(fs::is_regular_file(file), "there is no such file; it is looked for in the config's folder");
  check(fs::file_size(file) <= kMostBytes, "the preset has {} bytes; at most {} would be right",
        fs::file_size(file), kMostBytes);
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

}  // namespace

Json with_preset(const Json& config, const fs::path& file) {
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

}  // namespace qtrace::experiments
