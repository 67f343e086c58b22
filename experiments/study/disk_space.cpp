#include "experiments/study/disk_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

// Bytes per pixel.
constexpr double kSnapshot = 6 * 4;   // mean and variance in three channels
constexpr double kFiltered = 3 * 4;   // on top
constexpr double kFirstHit = 12 * 4;  // four vectors
constexpr double kState = 160;        // what a tracer gathers: 128 to 144, and room for its frame
// Bytes per frame: a line of frames.csv, and the same in the run's record.
constexpr double kFrame = 500;
constexpr double kRun = 40e3;  // manifests, records and a few blocks of the file system
constexpr double kEntry = 28;  // of a table: value, visits and sums

double pixels_of(const RenderSettings& render) { return static_cast<double>(render.width) * render.height; }

double table_entries(const RunConfig& config, const Scene& scene) {
  const RlSettings& rl = config.render.rl;
  if (config.render.sampler != Sampler::rl && !learns_lights(config.render)) return 0;
  const double bins = static_cast<double>(rl.bins_theta) * rl.bins_phi;
  if (rl.cells == CellKind::grid) {
    constexpr double kNormals = 6;
    return kNormals * rl.grid_resolution * rl.grid_resolution * rl.grid_resolution * bins;
  }
  const double sites = rl.sites_per_object > 0 ? static_cast<double>(rl.sites_per_object) *
                                                     static_cast<double>(scene.objects.size())
                                               : static_cast<double>(rl.total_sites);
  return sites * bins;
}

}  // namespace

double run_bytes(const RunConfig& config, const Scene& scene) {
  const auto snapshots = static_cast<double>(config.snapshots.resolve(config.frames).size());
  const double filtered = config.filter.kind == FilterKind::none ? 0 : kFiltered;
  const double saved = config.save_table == SaveTable::none        ? 0
                       : config.save_table == SaveTable::snapshots ? snapshots
                                                                   : 1;
  return pixels_of(config.render) * (snapshots * (kSnapshot + filtered) + kFirstHit) +
         kFrame * config.frames + saved * table_entries(config, scene) * 2 * sizeof(float) + kRun;
}

double checkpoint_bytes(const RunConfig& config, const Scene& scene) {
  return pixels_of(config.render) * kState + table_entries(config, scene) * kEntry + kFrame * config.frames;
}

double reference_bytes(const ReferenceSpec& spec) {
  return pixels_of(spec.settings) * (kState + 2 * kSnapshot) + kRun;
}

double needed_bytes(const Experiment& experiment, const std::vector<Turn>& left,
                    const std::vector<ReferenceSpec>& references, const ExperimentInputs& inputs) {
  double sum = 0, largest = 0;
  for (const Turn& turn : left) {
    const Run& run = experiment.runs[turn.place];
    const Scene& scene = inputs.of(turn).scene->scene;
    sum += run_bytes(run.config, scene);
    // Twice: the old one stays until the new one is whole.
    largest = std::max(largest, 2 * checkpoint_bytes(run.config, scene));
  }
  for (const ReferenceSpec& spec : references) sum += reference_bytes(spec);
  return sum + largest;
}

double free_bytes(const fs::path& folder) {
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there) && there.has_parent_path() && there != there.parent_path())
    there = there.parent_path();
  std::error_code error;
  const fs::space_info space = fs::space(there, error);
  return error ? std::numeric_limits<double>::infinity() : static_cast<double>(space.available);
}

std::string bytes_text(double bytes) {
  constexpr std::array<const char*, 5> kUnits{"bytes", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1000 && unit + 1 < kUnits.size()) bytes /= 1000, ++unit;
  return fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

}  // namespace qtrace::experiments
