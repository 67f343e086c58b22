#include "experiments/study/journal.h"

#include "experiments/files/atomic_file.h"
#include "experiments/images/exr_images.h"
#include "experiments/records/columns.h"
#include "experiments/records/figures.h"
#include "experiments/records/ratios.h"
#include "experiments/records/summary_page.h"
#include "experiments/run/run_files.h"
#include "experiments/runtime/manifest.h"
#include "experiments/study/results_folder.h"

#include <algorithm>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

// Between two writings: this many times what the last one took.
constexpr int kPauses = 50;

}  // namespace

bool met_expectation(const RunRecord& record) {
  return record.status == RunStatus::finished && !(record.verdict && record.verdict->word == "fail");
}

Journal::Journal(const Experiment& experiment, SceneStore& scenes, const gpu::DeviceInfo& device,
                 const ReferenceStore& references, fs::path folder)
    : experiment_(experiment),
      references_(references),
      device_(device_text(device)),
      folder_(std::move(folder)) {
  manifest_ = {{"schema", kResultsSchema},
               {"status", enum_name(RunStatus::running)},
               {"experiment", experiment.name},
               {"config_file", experiment.file.string()}};
  manifest_.update(identity_json(experiment, scenes, device));
  manifest_.update(Json{{"metrics", figures_json()},
                        {"timing", timing_note()},
                        {"warnings", experiment.warnings},
                        {"started", utc_now()}});
}

void Journal::adopt(RunRecord record) {
  if (record.status == RunStatus::partial) record.end_at_last_snapshot();
  const auto after = std::ranges::lower_bound(records_, record.place, {}, &RunRecord::place);
  if (after != records_.end() && after->place == record.place) {
    *after = std::move(record);
  } else {
    records_.insert(after, std::move(record));
  }
}

void Journal::add(RunRecord record) {
  adopt(std::move(record));
  if (Clock::now() - written_ >= kPauses * cost_) write();
}

const RunRecord* Journal::find(std::size_t place) const {
  const auto found = std::ranges::lower_bound(records_, place, {}, &RunRecord::place);
  return found != records_.end() && found->place == place ? &*found : nullptr;
}

bool Journal::all_finished() const {
  return records_.size() == experiment_.runs.size() && std::ranges::all_of(records_, met_expectation);
}

void Journal::close(const std::string& stopped, Progress& progress) {
  separate(progress);
  const bool all =
      records_.size() == experiment_.runs.size() &&
      std::ranges::all_of(records_, [](const RunRecord& r) { return r.status == RunStatus::finished; });
  manifest_["status"] = enum_name(!stopped.empty() ? RunStatus::partial
                                  : all            ? RunStatus::finished
                                                   : RunStatus::failed);
  if (!stopped.empty()) manifest_["stopped"] = stopped;
  manifest_["ended"] = utc_now();
  write();
}

std::string Journal::table() const {
  return experiment_table(experiment_, records_, references_.used(), device_);
}

std::vector<Configuration> Journal::collect() const {
  std::vector<Configuration> configurations = collect_configurations(records_);
  for (Configuration& configuration : configurations) {
    if (const auto parts = parts_.find(configuration.name); parts != parts_.end())
      configuration.parts = parts->second;
  }
  return configurations;
}

// Variance and bias of every configuration, from the images in its runs' folders.
void Journal::separate(Progress& progress) {
  std::string kept_hash;
  std::optional<StoredReference> kept;  // configurations of one scene share theirs
  for (const Configuration& configuration : collect_configurations(records_)) {
    if (configuration.members.size() < 2) continue;
    const auto image = [&](std::size_t seed) {
      const RunRecord& run = *configuration.members[seed];
      const fs::path file = snapshot_file(folder_ / run.run.id, run.last_snapshot()->frame);
      return to_radiance(read_exr(file), file);
    };
    try {
      const std::string& hash = configuration.members.front()->reference_hash;
      if (hash != kept_hash) {
        const Reference& reference = references_.used().at(hash);
        kept = read_reference(reference.file, reference.spec);
        kept_hash = hash;
      }
      if (const auto parts = separate_errors(configuration.members.size(), image, kept->image)) {
        parts_.insert_or_assign(configuration.name, *parts);
      }
    } catch (const std::exception& error) {
      progress.warning(
          fmt::format("{}: bias and variance are not told apart: {}", configuration.name, error.what()));
    }
  }
}

Json Journal::run_list() const {
  Json runs = Json::array();
  auto record = records_.begin();
  for (std::size_t i = 0; i < experiment_.runs.size(); ++i) {
    const bool is_there = record != records_.end() && record->place == i;
    Json run{{"run", experiment_.runs[i].id},
             {"status", enum_name(is_there ? record->status : RunStatus::waiting)}};
    if (is_there) {
      run["order"] = record->order;
      run["started"] = record->started;
      if (!record->reason.empty()) run["reason"] = record->reason;
      if (record->verdict) run["verdict"] = record->verdict->word;
      ++record;
    }
    runs.push_back(std::move(run));
  }
  return runs;
}

void Journal::write() {
  const auto start = Clock::now();
  manifest_["runs"] = run_list();
  write_file(folder_ / "summary.csv", csv_text(run_columns(experiment_.axes), records_));
  const std::vector<Configuration> configurations = collect();
  write_file(folder_ / "configurations.csv",
             csv_text(configuration_columns(experiment_.axes), configurations));
  if (!experiment_.baseline.empty()) {
    write_file(folder_ / "ratios.csv",
               csv_text(ratio_columns(), baseline_ratios(experiment_, configurations)));
  }
  write_file(folder_ / "summary.md", table());
  write_json(folder_ / "manifest.json", manifest_);
  written_ = Clock::now();
  cost_ = written_ - start;
}

}  // namespace qtrace::experiments
