#include "experiments/experiment.h"

#include "engine/core/check.h"
#include "engine/tracer/limits.h"
#include "experiments/atomic_file.h"
#include "experiments/cells.h"
#include "experiments/manifest.h"
#include "experiments/ratios.h"
#include "experiments/reference_store.h"
#include "experiments/run.h"
#include "experiments/table.h"
#include "experiments/text_table.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

bool met_expectation(const RunRecord& record) {
  return record.status == "finished" && !(record.verdict && record.verdict->word == "fail");
}

// The folder of an experiment that is running, rewritten after each run so that nothing is lost.
class Journal {
 public:
  Journal(const Experiment& experiment, const gpu::Context& context, const ReferenceStore& references,
          fs::path folder)
      : experiment_(experiment), context_(context), references_(references), folder_(std::move(folder)) {
    make_folder(folder_);
    manifest_ = {{"status", "running"},
                 {"experiment", experiment.name},
                 {"config_file", experiment.file.string()},
                 {"config", experiment.config},
                 {"device", device_json(context.device())},
                 {"program", program_json()},
                 {"metrics", metrics_json()},
                 {"timing", timing_note()},
                 {"warnings", experiment.warnings},
                 {"started", utc_now()}};
    write();
  }

  void add(RunRecord record) {
    const auto after = std::ranges::upper_bound(records_, record.place, {}, &RunRecord::place);
    records_.insert(after, std::move(record));
    write();
  }

  // Returns whether all runs finished and met what was expected of them.
  bool close(Progress& progress) {
    separate(progress);
    const bool all = std::all_of(records_.begin(), records_.end(),
                                 [](const RunRecord& record) { return record.status == "finished"; });
    manifest_["status"] = all ? "finished" : "failed";
    manifest_["ended"] = utc_now();
    write();
    return std::all_of(records_.begin(), records_.end(), met_expectation);
  }

  std::string table() const {
    return experiment_table(experiment_, records_, references_.used(), device_text(context_.device()));
  }

 private:
  std::vector<Cell> collect() const {
    std::vector<Cell> cells = collect_cells(records_);
    for (Cell& cell : cells) {
      if (const auto parts = parts_.find(cell.name); parts != parts_.end()) cell.parts = parts->second;
    }
    return cells;
  }

  // Variance and bias of every cell, from the images in its runs' folders.
  void separate(Progress& progress) {
    for (const Cell& cell : collect_cells(records_)) {
      if (cell.members.size() < 2) continue;
      const auto image = [&](std::size_t seed) {
        const RunRecord& run = *cell.members[seed];
        const fs::path file = snapshot_file(folder_ / run.run.id, run.last_snapshot()->frame);
        return to_radiance(read_exr(file), file);
      };
      try {
        const Reference& reference = references_.used().at(cell.members.front()->reference_hash);
        const StoredReference stored = read_reference(reference.file, reference.spec);
        if (const auto parts = separate_errors(cell.members.size(), image, stored.image)) {
          parts_.emplace(cell.name, *parts);
        }
      } catch (const std::exception& error) {
        progress.warning(
            fmt::format("{}: bias and variance are not told apart: {}", cell.name, error.what()));
      }
    }
  }

  void write() {
    Json runs = Json::array();
    auto record = records_.begin();
    for (std::size_t i = 0; i < experiment_.runs.size(); ++i) {
      const bool is_done = record != records_.end() && record->place == i;
      Json run{{"run", experiment_.runs[i].id}, {"status", is_done ? record->status : "waiting"}};
      if (is_done) {
        run["order"] = record->order;
        run["started"] = record->started;
        if (!record->reason.empty()) run["reason"] = record->reason;
        if (record->verdict) run["verdict"] = record->verdict->word;
        ++record;
      }
      runs.push_back(std::move(run));
    }
    manifest_["runs"] = runs;
    write_file(folder_ / "summary.csv", csv_text(run_columns(experiment_.axes), records_));
    const std::vector<Cell> cells = collect();
    write_file(folder_ / "cells.csv", csv_text(cell_columns(experiment_.axes), cells));
    if (!experiment_.baseline.empty()) {
      write_file(folder_ / "ratios.csv", csv_text(ratio_columns(), baseline_ratios(experiment_, cells)));
    }
    write_file(folder_ / "table.md", table());
    write_json(folder_ / "manifest.json", manifest_);
  }

  const Experiment& experiment_;
  const gpu::Context& context_;
  const ReferenceStore& references_;
  fs::path folder_;
  std::vector<RunRecord> records_;           // in the order of the config
  std::map<std::string, ErrorParts> parts_;  // by cell
  Json manifest_;
};

// Each reference that the runs need, once, and as good as any of them wishes it: its length shall not depend
// on the order of the runs.
std::vector<ReferenceSpec> needed_references(const Experiment& experiment, SceneStore& scenes) {
  std::vector<ReferenceSpec> specs;
  for (const Run& run : experiment.runs) {
    ReferenceSpec spec = reference_spec(run.config, scenes.load(experiment.reference_file(run)).hash);
    const auto same = std::ranges::find(specs, spec.hash, &ReferenceSpec::hash);
    if (same == specs.end()) {
      specs.push_back(std::move(spec));
    } else {
      same->wish = same->wish.joined(spec.wish);
    }
  }
  return specs;
}

std::string outlook_text(const ReferenceOutlook& outlook) {
  if (outlook.enough) return fmt::format("found with {} frames", outlook.frames);
  if (outlook.frames > 0) return fmt::format("to be extended from {} frames", outlook.frames);
  return "to be rendered";
}

void plan_work(const Experiment& experiment, const std::vector<ReferenceSpec>& needed,
               const fs::path& results_root, Progress& progress) {
  for (const Run& run : experiment.runs) progress.plan(run_work(run.config));
  for (const ReferenceSpec& spec : needed) {
    const ReferenceOutlook outlook = ReferenceStore::outlook(spec, results_root, experiment.folder());
    if (outlook.enough) continue;
    progress.plan(std::max(0, spec.wish.frames - outlook.frames) * spec.work_per_frame());
  }
}

std::string result_line(const std::string& label, const RunRecord& record) {
  if (record.status != "finished") return fmt::format("{}: failed: {}", label, record.reason);
  std::string line = fmt::format("{}: finished, {} frames in {:.3g} s, relMSE {:.3g}", label,
                                 record.frames.size(), record.elapsed_s(), record.final_errors()->relmse);
  if (record.verdict) line += ", verdict " + record.verdict->word;
  if (record.verdict && !record.verdict->reason.empty()) line += ": " + record.verdict->reason;
  return line;
}

}  // namespace

void load_scenes(const Experiment& experiment, SceneStore& scenes, Progress& progress) {
  std::set<std::string> said;
  const auto say = [&](const std::string& warning) {
    if (!warning.empty() && said.insert(warning).second) progress.warning(warning);
  };
  for (const std::string& warning : experiment.warnings) say(warning);
  for (const Run& run : experiment.runs) {
    try {
      const LoadedScene& scene = scenes.load(experiment.scene_file(run));
      for (const std::string& warning : scene.scene.warnings) say(scene.file.string() + ": " + warning);
      say(light_warning(scene, run.config));
      scenes.load(experiment.reference_file(run));
    } catch (const Error& error) {
      fail("{}: run '{}': {}", experiment.file.string(), run.id, error.what());
    }
  }
}

void check_device(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes) {
  for (const Run& run : experiment.runs) {
    try {
      const LoadedScene& scene = scenes.load(experiment.scene_file(run));
      check_limits(context, scene.scene, run.config.render);
      const LoadedScene& shown = scenes.load(experiment.reference_file(run));
      check_limits(context, shown.scene, reference_spec(run.config, shown.hash).settings);
    } catch (const Error& error) {
      fail("{}: run '{}': {}", experiment.file.string(), run.id, error.what());
    }
  }
}

std::string describe_runs(const Experiment& experiment, SceneStore& scenes, const fs::path& results_root) {
  std::vector<std::vector<std::string>> rows;
  for (const Run& run : experiment.runs) {
    const RenderSettings& render = run.config.render;
    const LoadedScene& scene = scenes.load(experiment.scene_file(run));
    rows.push_back({run.id, fmt::format("{} ({} triangles)", scene.scene.name, scene.scene.triangles.size()),
                    fmt::format("{}x{}", render.width, render.height), std::to_string(run.config.frames),
                    std::to_string(render.max_bounces), std::string(enum_name(render.sampler)),
                    std::string(enum_name(render.nee)), std::to_string(render.seed)});
  }
  std::string text = fmt::format("{}: {} runs\n", experiment.name, experiment.runs.size());
  text += plain_table({"run", "scene", "size", "frames", "bounces", "sampler", "nee", "seed"}, rows);
  for (const ReferenceSpec& spec : needed_references(experiment, scenes)) {
    const ReferenceOutlook outlook = ReferenceStore::outlook(spec, results_root, experiment.folder());
    text += fmt::format("reference {}: {}, {}\n", spec.hash, spec.wish.text(), outlook_text(outlook));
  }
  return text;
}

std::optional<fs::path> move_aside(const fs::path& folder) {
  if (!fs::exists(folder)) return std::nullopt;
  int number = 1;
  fs::path aside;
  do {
    aside = folder.string() + '.' + std::to_string(number++);
  } while (fs::exists(aside));
  std::error_code error;
  fs::rename(folder, aside, error);
  check(!error, "{}: earlier results cannot be moved to {}: {}", folder.string(), aside.string(),
        error.message());
  return aside;
}

std::vector<std::size_t> execution_order(const Experiment& experiment) {
  std::map<std::string, int> runs_of_cell;
  std::vector<std::pair<int, std::size_t>> turns;  // (repetition, place)
  for (std::size_t i = 0; i < experiment.runs.size(); ++i) {
    turns.emplace_back(runs_of_cell[experiment.runs[i].cell]++, i);
  }
  std::ranges::sort(turns);
  std::vector<std::size_t> order;
  for (const auto& [repetition, place] : turns) order.push_back(place);
  return order;
}

bool run_experiment(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes,
                    const fs::path& results_root, Progress& progress) {
  const fs::path folder = results_root / experiment.name;
  make_folder(results_root);
  if (const auto aside = move_aside(folder)) {
    progress.note(fmt::format("{}: earlier results are kept as {}", folder.string(), aside->string()));
  }
  const std::vector<ReferenceSpec> needed = needed_references(experiment, scenes);
  plan_work(experiment, needed, results_root, progress);
  ReferenceStore references(context, results_root, progress);
  Journal journal(experiment, context, references, folder);
  int order = 0;
  for (const std::size_t place : execution_order(experiment)) {
    const Run& run = experiment.runs[place];
    ++order;
    const LoadedScene& scene = scenes.load(experiment.scene_file(run));
    const LoadedScene& shown = scenes.load(experiment.reference_file(run));
    const auto reference = [&] {
      const std::string hash = reference_spec(run.config, shown.hash).hash;
      const auto spec = std::ranges::find(needed, hash, &ReferenceSpec::hash);
      return references.get(*spec, shown, experiment.folder());
    };
    const std::string label = fmt::format("run {}/{} {}", order, experiment.runs.size(), run.id);
    RunRecord record = execute_run(
        {context, experiment, run, scene, shown.hash, reference, folder / run.id, label}, progress);
    record.place = place;
    record.order = order;
    if (met_expectation(record)) {
      progress.note(result_line(label, record));
    } else {
      progress.warning(result_line(label, record));
    }
    journal.add(std::move(record));
  }
  const bool all_good = journal.close(progress);
  fmt::print("{}\nFiles: {}\n", journal.table(), folder.string());
  return all_good;
}

}  // namespace qtrace::experiments
