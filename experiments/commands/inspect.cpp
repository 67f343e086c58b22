#include "experiments/commands/inspect.h"

#include "engine/core/check.h"
#include "engine/tracer/inspection.h"
#include "experiments/config/config.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/text_table.h"
#include "experiments/images/exr.h"
#include "experiments/run/saved_table.h"
#include "experiments/runtime/scene_store.h"
#include "experiments/runtime/version.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr int kHemisphereSize = 192;

// A run's folder, read back: what it was told, and what its table had learned.
struct InspectedRun {
  std::filesystem::path folder;
  RunConfig config;
  std::string config_hash;
  LoadedScene scene;
  SavedTable table;
};

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

LoadedScene load_scene(const fs::path& file, const View& view,
                       const std::optional<EnvironmentImage>& environment, const std::string& hash) {
  check(is_file(file), "{}: the scene of this run is not there; inspect it from the folder where it was run",
        file.string());
  SceneStore store;
  LoadedScene scene = store.load(file, view, environment);
  check(scene.hash == hash,
        "{}: this scene has changed since the run (its hash was {} and is {}), so that the table's cells lie "
        "elsewhere; "
        "run the experiment again",
        file.string(), hash, scene.hash);
  return scene;
}

// Throws Error: not the folder of a run, no direction bins, no table of this frame (none: the last one), or a
// scene that is gone or has changed since.
InspectedRun read_inspected_run(const fs::path& folder, std::optional<int> frame) {
  const fs::path file = folder / "manifest.json";
  check(is_file(file),
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
  std::optional<EnvironmentImage> environment = run.config.environment_image;
  if (environment)
    environment->file = text_at(manifest.value("scene", Json::object()), file, "environment", "file");
  run.scene = load_scene(text_at(manifest, file, "scene", "file"), view_of(run.config), environment,
                         text_at(manifest, file, "scene", "hash"));
  return run;
}

// Rows of the saved table, and what they are worth as pictures.
class LearnedTable {
 public:
  LearnedTable(const SavedTable& table, const RlSettings& rl)
      : table_(table), bins_(static_cast<std::size_t>(rl.bins_theta * rl.bins_phi)) {}

  std::size_t bins() const { return bins_; }
  float value(int cell, std::size_t bin) const { return table_.values.values[first(cell) + bin]; }
  std::uint64_t visits(int cell) const {
    const auto row = table_.visits.values.begin() + static_cast<std::ptrdiff_t>(first(cell));
    return std::accumulate(row, row + static_cast<std::ptrdiff_t>(bins_), std::uint64_t{0});
  }

 private:
  std::size_t first(int cell) const { return static_cast<std::size_t>(cell) * table_.values.columns; }

  const SavedTable& table_;
  std::size_t bins_;  // the columns of a row that belong to directions
};

// False colour of a cell, a byte of its hash per channel, so that neighbours differ: the finaliser of
// MurmurHash3 (Appleby 2011).
glm::vec3 false_colour(int cell) {
  auto x = static_cast<std::uint64_t>(cell + 1);
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  x ^= x >> 33;
  const auto channel = [x](int shift) {
    return 0.02F + 0.98F * static_cast<float>((x >> shift) & 255U) / 255.0F;
  };
  return {channel(0), channel(8), channel(16)};
}

ExrImage cell_image(const RenderSettings& settings, const std::vector<int>& cells,
                    const LearnedTable& table) {
  ExrImage image{settings.width, settings.height, {}, {}};
  for (const int cell : cells) {
    const glm::vec3 colour = cell < 0 ? glm::vec3(0) : false_colour(cell);
    image.channels["cell"].push_back(static_cast<float>(cell));
    image.channels["visits"].push_back(cell < 0 ? 0.0F : static_cast<float>(table.visits(cell)));
    image.channels["R"].push_back(colour.r);
    image.channels["G"].push_back(colour.g);
    image.channels["B"].push_back(colour.b);
  }
  return image;
}

ExrImage hemisphere_image(const Hemisphere& hemisphere, int cell, const LearnedTable& table) {
  ExrImage image{hemisphere.size, hemisphere.size, {}, {}};
  for (std::size_t i = 0; i < hemisphere.bin.size(); ++i) {
    const bool inside = hemisphere.bin[i] >= 0;
    const auto bin = static_cast<std::size_t>(inside ? hemisphere.bin[i] : 0);
    const glm::dvec3 radiance = inside ? hemisphere.radiance[i] : glm::dvec3(0);
    image.channels["bin"].push_back(static_cast<float>(hemisphere.bin[i]));
    image.channels["learned"].push_back(inside ? table.value(cell, bin) : 0.0F);
    image.channels["true.R"].push_back(static_cast<float>(radiance.r));
    image.channels["true.G"].push_back(static_cast<float>(radiance.g));
    image.channels["true.B"].push_back(static_cast<float>(radiance.b));
    image.channels["true_bin"].push_back(inside ? static_cast<float>(hemisphere.bin_radiance[bin]) : 0.0F);
  }
  return image;
}

// Of learned and true values over the bins: means weighted by the cosine, and Pearson's correlation, which is
// not a number where either is constant.
struct Agreement {
  double learned = 0;
  double truth = 0;
  double correlation = 0;
};

Agreement compare_bins(const Hemisphere& hemisphere, int cell, const LearnedTable& table) {
  double weight = 0, n = 0, l = 0, t = 0, ll = 0, tt = 0, lt = 0;
  Agreement result;
  for (std::size_t bin = 0; bin < table.bins(); ++bin) {
    const double truth = hemisphere.bin_radiance[bin];
    if (std::isnan(truth)) continue;
    const double learned = table.value(cell, bin);
    const double cosine = hemisphere.bin_cosine[bin];
    result.learned += cosine * learned;
    result.truth += cosine * truth;
    weight += cosine;
    n += 1;
    l += learned;
    t += truth;
    ll += learned * learned;
    tt += truth * truth;
    lt += learned * truth;
  }
  result.learned /= weight;
  result.truth /= weight;
  result.correlation = (n * lt - l * t) / std::sqrt((n * ll - l * l) * (n * tt - t * t));
  return result;
}

glm::ivec2 pixel_of(const InspectOptions& options, const RenderSettings& settings) {
  if (options.pixel.empty()) return {settings.width / 2, settings.height / 2};
  const glm::ivec2 pixel(options.pixel[0], options.pixel[1]);
  check(pixel.x >= 0 && pixel.x < settings.width && pixel.y >= 0 && pixel.y < settings.height,
        "--pixel {},{} lies outside the image of {} x {} pixels, whose first one is 0,0", pixel.x, pixel.y,
        settings.width, settings.height);
  return pixel;
}

void check_shape(const InspectedRun& run, const Inspection& inspection) {
  const NpyTable<float>& values = run.table.values;
  check(values.rows == inspection.cells().size() && values.columns == inspection.actions(),
        "{}: the table of frame {} is {} x {}, but this run has {} cells and {} columns; the files do not "
        "belong to it",
        run.folder.string(), run.table.frame, values.rows, values.columns, inspection.cells().size(),
        inspection.actions());
}

std::string figures_text(const InspectedRun& run, glm::ivec2 pixel, int cell, const CellState& state,
                         const LearnedTable& table, const Agreement& agreement) {
  const glm::dvec3 p = glm::dvec3(state.position) + run.scene.scene.origin;
  return plain_table({"figure", "value"},
                     {{"pixel", fmt::format("{},{}", pixel.x, pixel.y)},
                      {"cell", fmt::format("{} of {}", cell, run.table.values.rows)},
                      {"position", fmt::format("{:.4g} {:.4g} {:.4g}", p.x, p.y, p.z)},
                      {"table after frame", std::to_string(run.table.frame)},
                      {"visits", std::to_string(table.visits(cell))},
                      {"learned mean over bins, by cosine", fmt::format("{:.4g}", agreement.learned)},
                      {"true mean over bins, by cosine", fmt::format("{:.4g}", agreement.truth)},
                      {"correlation over bins", fmt::format("{:.3f}", agreement.correlation)}});
}

}  // namespace

std::string inspect_run(const InspectOptions& options, Progress& progress) {
  const InspectedRun run = read_inspected_run(options.folder, options.frame);
  const RenderSettings& settings = run.config.render;
  const glm::ivec2 pixel = pixel_of(options, settings);
  const gpu::Context context(options.device);
  const Inspection inspection(context, run.scene.scene, settings);
  check_shape(run, inspection);
  const std::vector<int> cells = inspection.pixel_cells();
  const int cell = cells[static_cast<std::size_t>(pixel.y * settings.width + pixel.x)];
  check(cell >= 0,
        "the centre of pixel {},{} shows no surface that belongs to a cell; choose another with --pixel",
        pixel.x, pixel.y);
  constexpr double kWorkPerSample = double{kHemisphereSize} * kHemisphereSize;
  progress.plan(kWorkPerSample * options.samples);
  progress.begin("hemisphere", options.samples, kWorkPerSample);
  const Hemisphere hemisphere = inspection.hemisphere(pixel, kHemisphereSize, options.samples,
                                                      [&](int sample) { progress.step(sample); });
  progress.end();

  const LearnedTable table(run.table, settings.rl);
  ExrImage cell_picture = cell_image(settings, cells, table);
  ExrImage hemisphere_picture = hemisphere_image(hemisphere, cell, table);
  for (ExrImage* picture : {&cell_picture, &hemisphere_picture}) {
    picture->metadata = {{"pixel", fmt::format("{},{}", pixel.x, pixel.y)},
                         {"cell", std::to_string(cell)},
                         {"frame", std::to_string(run.table.frame)},
                         {"samples", std::to_string(options.samples)},
                         {"configHash", run.config_hash},
                         {"software", software()}};
  }
  const std::filesystem::path folder = run.folder / "inspect";
  make_folder(folder);
  const std::filesystem::path name = folder / fmt::format("hemisphere_{}_{}.exr", pixel.x, pixel.y);
  write_exr(name, hemisphere_picture);
  write_exr(folder / "cells.exr", cell_picture);
  return figures_text(run, pixel, cell, inspection.cells()[static_cast<std::size_t>(cell)], table,
                      compare_bins(hemisphere, cell, table)) +
         fmt::format("\nFiles: {} {}\n", (folder / "cells.exr").string(), name.string());
}

void add_inspect_command(CLI::App& app, Action& action) {
  const auto kept = std::make_shared<InspectOptions>();
  InspectOptions& options = *kept;
  constexpr int kMostSamples = 1 << 20;
  CLI::App* inspect =
      app.add_subcommand("inspect", "Pictures of a run's cells, and of what one of them has learned");
  inspect->add_option("RUN_FOLDER", options.folder, "results/<experiment>/<run>, made with save_table")
      ->required();
  inspect->add_option("--pixel", options.pixel, "X,Y: whose cell is shown (default: the middle of the image)")
      ->delimiter(',')
      ->expected(2);
  inspect->add_option("--samples", options.samples, "paths per pixel of the true hemisphere")
      ->capture_default_str()
      ->check(CLI::Range(1, kMostSamples));
  inspect->add_option("--frame", options.frame, "after which frame the table was saved (default: the last)");
  inspect->add_option("--device", options.device, "index or part of a name, see `qtrace devices`");
  inspect->callback([&action, kept] {
    action = [kept] {
      Progress progress(Progress::detect(false));
      fmt::print("{}", inspect_run(*kept, progress));
      return 0;
    };
  });
}

}  // namespace qtrace::experiments
