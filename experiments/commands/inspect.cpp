#include "experiments/commands/inspect.h"

#include "engine/core/check.h"
#include "engine/tracer/inspection.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr.h"
#include "experiments/commands/inspected_run.h"
#include "experiments/files/text_table.h"
#include "experiments/runtime/version.h"

#include <cmath>
#include <numeric>

namespace qtrace::experiments {
namespace {

constexpr int kHemisphereSize = 192;

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

}  // namespace qtrace::experiments
