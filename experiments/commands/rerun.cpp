#include "experiments/commands/rerun.h"

#include "engine/core/check.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr.h"
#include "experiments/reference/reference_store.h"
#include "experiments/run/run.h"
#include "experiments/runtime/driver_store.h"
#include "experiments/runtime/manifest.h"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <set>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

// A folder that goes away again unless it is to be kept.
class Place {
 public:
  explicit Place(const std::string& out)
      : is_kept_(!out.empty()),
        path_(is_kept_ ? fs::path(out)
                       : fs::temp_directory_path() / fmt::format("qtrace-rerun-{}", ::getpid())) {
    make_folder(path_);
  }
  ~Place() {
    std::error_code ignored;
    if (!is_kept_) fs::remove_all(path_, ignored);
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  const fs::path& path() const { return path_; }

 private:
  bool is_kept_;
  fs::path path_;
};

const Json& part(const Json& manifest, const char* name, const fs::path& file) {
  check(manifest.is_object() && manifest.contains(name),
        "{}: has no '{}', so it is no manifest of a run: results/<experiment>/<run>/manifest.json is needed",
        file.string(), name);
  return manifest.at(name);
}

// Where a scene or an image is now: beside the results as it was, or where the manifest says.
fs::path place_of(const Json& json, const fs::path& manifest) {
  const fs::path beside = (manifest.parent_path() / json.value("from_here", "")).lexically_normal();
  return is_file(beside) ? beside : fs::path(json.value("file", ""));
}

const LoadedScene& load_scene(const Json& scene, const fs::path& manifest, const RunConfig& config,
                              SceneStore& scenes) {
  std::optional<EnvironmentImage> environment = config.environment_image;
  if (environment) environment->file = place_of(part(scene, "environment", manifest), manifest).string();
  return scenes.load(place_of(scene, manifest), view_of(config), environment);
}

Run run_of(const Json& manifest, const fs::path& file) {
  Run run;
  run.id = part(manifest, "run", file).get<std::string>();
  // Manifests of schema 1 call it a cell.
  run.configuration =
      part(manifest, manifest.contains("cell") ? "cell" : "configuration", file).get<std::string>();
  try {
    read_knobs(part(manifest, "config", file), run.config);
  } catch (const Error& error) {
    fail("{}: its config is not one of this program: {}", file.string(), error.what());
  }
  for (const auto& [axis, label] : part(manifest, "axes", file).items())
    run.labels.push_back(label.get<std::string>());
  return run;
}

// Empty where the images are the same to the bit.
std::string image_difference(const fs::path& before, const fs::path& now) {
  const ExrImage a = read_exr(before);
  const ExrImage b = read_exr(now);
  if (a.width != b.width || a.height != b.height) return "another size";
  const auto width = static_cast<std::size_t>(a.width);
  std::set<std::size_t> pixels;
  for (const auto& [name, plane] : a.channels) {
    const auto other = b.channels.find(name);
    if (other == b.channels.end()) return fmt::format("no channel {}", name);
    for (std::size_t i = 0; i < plane.size(); ++i) {
      if (std::memcmp(&plane[i], &other->second[i], sizeof(float)) != 0) pixels.insert(i);
    }
  }
  if (pixels.empty()) return "";
  return fmt::format("{} of {} pixels differ, the first at ({}, {})", pixels.size(),
                     width * static_cast<std::size_t>(a.height), *pixels.begin() % width,
                     *pixels.begin() / width);
}

std::string compare_folders(const fs::path& before, const fs::path& now, bool& agrees) {
  std::string differences;
  int compared = 0;
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(before)) files.insert(entry.path());
  for (const fs::path& file : files) {
    const bool is_image = file.extension() == ".exr";
    if (!is_image && file.extension() != ".npy") continue;
    ++compared;
    const fs::path other = now / file.filename();
    std::string difference;
    if (!fs::exists(other)) {
      difference = "is not written again";
    } else if (is_image) {
      difference = image_difference(file, other);
    } else if (read_file(file) != read_file(other)) {
      difference = "the numbers differ";
    }
    if (!difference.empty()) differences += fmt::format("  {}: {}\n", file.filename().string(), difference);
  }
  agrees = differences.empty() && compared > 0;
  if (compared == 0) return "the bits cannot be compared: the folder holds no images\n";
  return agrees ? fmt::format("the bits agree in all {} images and tables\n", compared)
                : fmt::format("the bits do not agree:\n{}", differences);
}

// What may explain a difference, or is worth knowing where there is none.
std::string changes_text(const Json& before, const Json& now) {
  std::string text;
  for (const char* name : {"program", "device"}) {
    for (const auto& [key, value] : now.at(name).items()) {
      const Json was = before.contains(name) ? before.at(name).value(key, Json()) : Json();
      if (was != value) text += fmt::format("  {} {}: was {}, is {}\n", name, key, show(was), show(value));
    }
  }
  return text.empty() ? "the program and the device are the same\n" : "other than then:\n" + text;
}

}  // namespace

RerunResult rerun(const RerunOptions& options, Progress& progress) {
  const fs::path& file = options.manifest;
  const Json manifest = read_json_file(file);
  Experiment experiment;
  experiment.name = part(manifest, "experiment", file).get<std::string>();
  experiment.file = file;
  experiment.runs.push_back(run_of(manifest, file));
  for (const auto& [axis, label] : manifest.at("axes").items()) experiment.axes.push_back({axis, false, {}});
  const Run& run = experiment.runs.front();
  SceneStore scenes;
  const LoadedScene& scene = load_scene(part(manifest, "scene", file), file, run.config, scenes);
  const LoadedScene& shown = load_scene(part(manifest, "reference_scene", file), file, run.config, scenes);
  check(scene.hash == manifest.at("scene").value("hash", ""),
        "{}: the content of {}{} is not what was rendered then: its hash was {} and is {}", file.string(),
        scene.file.string(),
        scene.environment_file.empty() ? "" : " or of " + scene.environment_file.string(),
        manifest.at("scene").value("hash", ""), scene.hash);
  gpu::Context context(options.device);
  keep_choices(context, part(manifest, "device", file));
  const Place place(options.out);
  const Stopper stopper;
  ReferenceStore references(context, place.path(), stopper, progress);
  const ReferenceSpec spec = reference_spec(run.config, shown.hash);
  const RunInputs inputs = run_inputs(run, scene, shown, spec, context.device());
  const auto reference = [&] {
    const fs::path results = fs::absolute(file).parent_path().parent_path().parent_path();
    return references.get(spec, shown, results);
  };
  FileQueue files;
  const fs::path folder = place.path() / experiment.name / run.id;
  progress.plan(run_work(run.config));
  const RunEnd end = execute_run({.context = context,
                                  .experiment = experiment,
                                  .run = run,
                                  .inputs = inputs,
                                  .get_reference = reference,
                                  .folder = folder,
                                  .files = files,
                                  .label = run.id,
                                  .stopper = &stopper},
                                 progress);
  files.flush();
  if (end.stopped) throw *end.stopped;
  check(end.record.status == RunStatus::finished, "{}: done again, the run fails: {}", file.string(),
        end.record.reason);
  RerunResult result;
  result.text =
      fmt::format("{} of {}: ", run.id, experiment.name) +
      compare_folders(file.parent_path().empty() ? "." : file.parent_path(), folder, result.agrees) +
      changes_text(manifest, {{"program", program_json()}, {"device", device_json(context.device())}});
  return result;
}

void add_rerun_command(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RerunOptions>();
  CLI::App* again = app.add_subcommand("rerun", "Does a run again from its manifest; do the bits agree?");
  again->add_option("MANIFEST", options->manifest, "results/<experiment>/<run>/manifest.json")->required();
  again->add_option("--out", options->out, "keeps the new files in this folder");
  again->add_option("--device", options->device, "index or part of a name, see `qtrace devices`");
  again->callback([&action, options] {
    action = [options] {
      Progress progress(Progress::detect(false));
      const RerunResult result = rerun(*options, progress);
      fmt::print("{}", result.text);
      return result.agrees ? 0 : 1;
    };
  });
}

}  // namespace qtrace::experiments
