#include "experiments/commands/inspected_run.h"

#include "engine/core/check.h"

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

// The member at a dotted path. Throws Error that names the manifest where there is none or no text.
std::string text_at(const Json& manifest, const fs::path& file, const std::string& group,
                    const std::string& key) {
  const Json& place = group.empty() ? manifest : manifest.value(group, Json::object());
  check(place.is_object() && place.contains(key) && place.at(key).is_string(),
        "{}: has no text '{}{}{}', so it is not the manifest of a run", file.string(), group,
        group.empty() ? "" : ".", key);
  return place.at(key).get<std::string>();
}

RunConfig config_of(const Json& manifest, const fs::path& file) {
  RunConfig config;
  try {
    read_knobs(manifest.value("config", Json()), config);
    check_run_config(config);
  } catch (const Error& error) {
    fail("{}: {}", file.string(), error.what());
  }
  return config;
}

LoadedScene load_scene(const fs::path& file, const std::string& hash) {
  check(fs::is_regular_file(file),
        "{}: the scene of this run is not there; inspect it from the folder where it was run", file.string());
  SceneStore store;
  LoadedScene scene = store.load(file);
  check(scene.hash == hash,
        "{}: this scene has changed since the run (its hash was {} and is {}), so that the table's cells lie "
        "elsewhere; "
        "run the experiment again",
        file.string(), hash, scene.hash);
  return scene;
}

}  // namespace

InspectedRun read_inspected_run(const fs::path& folder, std::optional<int> frame) {
  const fs::path file = folder / "manifest.json";
  check(fs::is_regular_file(file),
        "{}: is not the folder of a run, which has a manifest.json: results/<experiment>/<run>",
        folder.string());
  const Json manifest = read_json_file(file);
  check(manifest.is_object() && manifest.contains("run"),
        "{}: is the folder of an experiment; name one of the runs in it", folder.string());
  InspectedRun run;
  run.folder = folder;
  run.config = config_of(manifest, file);
  run.config_hash = text_at(manifest, file, "", "config_hash");
  check(run.config.render.sampler == Sampler::rl,
        "{}: this run has learned no directions, because its sampler is {}; only runs with sampler rl can be "
        "inspected",
        folder.string(), enum_name(run.config.render.sampler));
  run.table = read_saved_table(folder, frame);
  run.scene = load_scene(text_at(manifest, file, "scene", "file"), text_at(manifest, file, "scene", "hash"));
  return run;
}

}  // namespace qtrace::experiments
