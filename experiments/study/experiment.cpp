#include "experiments/study/experiment.h"

#include "engine/core/check.h"
#include "engine/tracer/limits.h"
#include "experiments/run/run.h"
#include "experiments/run/run_store.h"
#include "experiments/runtime/driver_store.h"
#include "experiments/study/calibration.h"
#include "experiments/study/disk_space.h"
#include "experiments/study/experiment_inputs.h"
#include "experiments/study/journal.h"
#include "experiments/study/plan.h"
#include "experiments/study/results_folder.h"

#include <algorithm>
#include <cstdio>
#include <set>

namespace qtrace::experiments {
namespace {

namespace fs = std::filesystem;

constexpr int kContexts = 3;  // a run is tried in this many, if each is lost

std::string result_line(const std::string& label, const RunRecord& record) {
  if (record.status == RunStatus::failed) return fmt::format("{}: failed: {}", label, record.reason);
  if (record.status == RunStatus::partial)
    return fmt::format("{}: {} frames so far", label, record.frames.size());
  std::string line = fmt::format("{}: finished, {} frames in {:.3g} s, relMSE {:.3g}", label,
                                 record.frames.size(), record.elapsed_s(), record.final_errors()->relmse);
  if (record.verdict) line += ", verdict " + record.verdict->word;
  if (record.verdict && !record.verdict->reason.empty()) line += ": " + record.verdict->reason;
  return line;
}

// An experiment at work.
class Work {
 public:
  Work(const Experiment& experiment, gpu::Context& context, SceneStore& scenes, const RunChoices& choices,
       const Stopper& stopper, const GiveUp& give_up, Progress& progress)
      : experiment_(experiment),
        context_(context),
        choices_(choices),
        stopper_(stopper),
        give_up_(give_up),
        progress_(progress),
        folder_(experiment, identity_json(experiment, scenes, context.device()), choices.root, choices.shard,
                choices.fresh, progress),
        turns_(chosen_turns(experiment, choices)),
        inputs_(experiment, scenes, context.device()),
        needed_(inputs_.references(turns_)),
        references_(context, choices.root, stopper, progress),
        journal_(experiment, scenes, context.device(), references_, folder_.path()),
        files_(context.device().software ? FileQueue::Content::at_once : FileQueue::Content::by_thread) {}

  ~Work() { progress_.forget(); }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  bool run() {
    progress_.keep_in(folder_.path(), choices_.shard.is_whole() ? "" : choices_.shard.text());
    adopt_earlier();
    if (!choices_.merge) {
      plan();
      if (choices_.shard.is_whole()) journal_.write();
      render();
    }
    if (choices_.references_only) return true;
    return close("");
  }

 private:
  const Run& run_of(const Turn& turn) const { return experiment_.runs[turn.place]; }

  RunStore store_of(const Turn& turn) const {
    return {folder_.path() / run_of(turn).id, inputs_.of(turn).identity};
  }

  // What earlier calls finished, of all runs: the files about the experiment show those that are not chosen,
  // too.
  void adopt_earlier() {
    const auto complain = [this](const Error& error) {
      progress_.warning(fmt::format("this run is done again: {}", error.what()));
    };
    std::size_t found = 0;
    for (const Turn& turn : execution_order(experiment_)) {
      const RunStore store = store_of(turn);
      auto record = store.read_record(run_of(turn), complain);
      if (!record) continue;
      record->place = turn.place;
      record->order = turn.order;
      if (record->status == RunStatus::finished) {
        ++found;
        store.remove_checkpoint(files_);  // the process may have ended before it did
      }
      journal_.adopt(std::move(*record));
    }
    if (found > 0) {
      progress_.note(fmt::format("{}: {} of {} runs are there already", folder_.path().string(), found,
                                 experiment_.runs.size()));
    }
  }

  bool is_done(const Turn& turn) const {
    const RunRecord* record = journal_.find(turn.place);
    if (record == nullptr || record->status == RunStatus::partial) return false;
    return record->status == RunStatus::finished || choices_.keep_failed;
  }

  // Time and room for what is left. Throws Error where the disk has no room for it.
  void plan() {
    std::vector<Turn> left;
    for (const Turn& turn : turns_) {
      if (is_done(turn) || choices_.references_only) continue;
      left.push_back(turn);
      progress_.plan(run_work(run_of(turn).config));
    }
    std::vector<ReferenceSpec> missing;
    for (const ReferenceSpec& spec : needed_) {
      const ReferenceOutlook outlook = ReferenceStore::outlook(spec, choices_.root, experiment_.folder());
      if (outlook.enough) continue;
      missing.push_back(spec);
      progress_.plan(std::max(0, spec.wish.frames - outlook.frames) * spec.work_per_frame());
    }
    const double needed = needed_bytes(experiment_, left, missing, inputs_);
    const double free = free_bytes(folder_.path());
    check(needed <= free,
          "{}: what is left to do needs up to {} there and {} are free: make room, write elsewhere by --out, "
          "or keep "
          "fewer snapshots",
          folder_.path().string(), bytes_text(needed), bytes_text(free));
  }

  // With a time budget, all configurations grow together.
  int rounds() {
    const auto budget = stopper_.seconds_left();
    if (!budget) return 1;
    std::vector<Turn> firsts;
    for (const Turn& turn : turns_) {
      if (turn.repetition == 0 && !is_done(turn)) firsts.push_back(turn);
    }
    const Calibration calibration(experiment_, firsts, context_, inputs_, progress_);
    double seconds = 0;
    for (const Turn& turn : firsts) seconds += calibration.seconds(run_of(turn), run_of(turn).config.frames);
    const int rounds = rounds_for(seconds, *budget);
    progress_.note(
        fmt::format("one run of each configuration takes about {}: the configurations grow in {} rounds",
                    duration_text(seconds), rounds));
    return rounds;
  }

  void render() {
    try {
      if (choices_.references_only) {
        for (const Turn& turn : turns_) reference_of(turn);
        return;
      }
      for (const Step& step : steps_of(experiment_, turns_, rounds())) {
        stopper_.check();
        if (!is_done(step.turn)) take(step);
      }
    } catch (const Stopped& stopped) {
      close(stopped.why);
      throw;
    }
  }

  void take(const Step& step) {
    const Run& run = run_of(step.turn);
    const std::string label = fmt::format("run {}/{} {}", step.turn.order, experiment_.runs.size(), run.id);
    auto [record, stopped] = execute(step, label);
    record.place = step.turn.place;
    record.order = step.turn.order;
    if (record.status == RunStatus::partial || met_expectation(record)) {
      progress_.note(result_line(label, record));
    } else {
      progress_.warning(result_line(label, record));
    }
    const bool has_failed = record.status == RunStatus::failed;
    journal_.add(std::move(record));
    if (stopped) throw *stopped;
    if (has_failed && choices_.fail_fast) throw Stopped{fmt::format("{} failed (--fail-fast)", run.id), 1};
  }

  // Again in a new context where one was lost; the checkpoint saves what was done.
  RunEnd execute(const Step& step, const std::string& label) {
    const Run& run = run_of(step.turn);
    for (int attempt = 1;; ++attempt) {
      try {
        return execute_run({.context = context_,
                            .experiment = experiment_,
                            .run = run,
                            .inputs = inputs_.of(step.turn),
                            .get_reference = [&] { return reference_of(step.turn); },
                            .folder = folder_.path() / run.id,
                            .files = files_,
                            .label = label,
                            .stopper = &stopper_,
                            .until = step.until,
                            .watchdog = &watchdog_,
                            .give_up = give_up_},
                           progress_);
      } catch (const gpu::ContextLost& lost) {
        if (attempt == kContexts) throw Stopped{lost.what(), 1};
        progress_.warning(fmt::format("{}: {}; going on in a new context", label, lost.what()));
        context_.renew();
      }
    }
  }

  const ReferenceSpec& needed_by(const Turn& turn) const {
    return *std::ranges::find(needed_, inputs_.of(turn).reference_hash, &ReferenceSpec::hash);
  }

  std::shared_ptr<const Reference> reference_of(const Turn& turn) {
    return references_.get(needed_by(turn), *inputs_.of(turn).shown, experiment_.folder());
  }

  // Returns whether all is done. A shard leaves the files about all runs to the merge.
  bool close(const std::string& stopped) {
    if (!choices_.shard.is_whole()) {
      files_.flush();
      return std::ranges::all_of(turns_, [this](const Turn& turn) {
        const RunRecord* record = journal_.find(turn.place);
        return record != nullptr && met_expectation(*record);
      });
    }
    for (const Turn& turn : turns_) {
      references_.note(needed_by(turn), *inputs_.of(turn).shown, experiment_.folder());
    }
    try {
      files_.flush();  // images are read again
      journal_.close(stopped, progress_);
    } catch (const Error& error) {
      if (stopped.empty()) throw;
      progress_.warning(error.what());  // the disk may be full, which is why the work was stopped
    }
    if (!choices_.references_only) fmt::print("{}\nFiles: {}\n", journal_.table(), folder_.path().string());
    return journal_.all_finished();
  }

  const Experiment& experiment_;
  gpu::Context& context_;
  const RunChoices& choices_;
  const Stopper& stopper_;
  const GiveUp& give_up_;
  Progress& progress_;
  ResultsFolder folder_;
  std::vector<Turn> turns_;
  ExperimentInputs inputs_;
  std::vector<ReferenceSpec> needed_;
  ReferenceStore references_;
  Journal journal_;
  FileQueue files_;
  Watchdog watchdog_;  // ends first: it may put files
};

}  // namespace

std::vector<Experiment> load_experiments(const std::vector<std::string>& files,
                                         const std::vector<std::string>& sets, SceneStore& scenes,
                                         Progress& progress) {
  std::vector<Experiment> experiments;
  for (const std::string& file : files) {
    Experiment next = load_experiment(file, sets);
    for (const Experiment& other : experiments) {
      check(other.name != next.name, "{} and {} are both called '{}'; their results would share a folder",
            other.file.string(), next.file.string(), next.name);
    }
    load_scenes(next, scenes, progress);
    experiments.push_back(std::move(next));
  }
  return experiments;
}

void load_scenes(const Experiment& experiment, SceneStore& scenes, Progress& progress) {
  std::set<std::string> said;
  const auto say = [&](const std::string& warning) {
    if (!warning.empty() && said.insert(warning).second) progress.warning(warning);
  };
  for (const std::string& warning : experiment.warnings) say(warning);
  for (const Run& run : experiment.runs) {
    try {
      const auto environment = experiment.environment_image(run);
      const LoadedScene& scene = scenes.load(experiment.scene_file(run), view_of(run.config), environment);
      for (const std::string& warning : scene.scene.warnings) say(scene.file.string() + ": " + warning);
      say(light_warning(scene, run.config));
      scenes.load(experiment.reference_file(run), view_of(run.config), environment);
    } catch (const Error& error) {
      fail("{}: run '{}': {}", experiment.file.string(), run.id, error.what());
    }
  }
}

void check_device(const Experiment& experiment, const gpu::Context& context, SceneStore& scenes) {
  for (const Run& run : experiment.runs) {
    try {
      const auto environment = experiment.environment_image(run);
      const LoadedScene& scene = scenes.load(experiment.scene_file(run), view_of(run.config), environment);
      check_limits(context, scene.scene, run.config.render);
      const LoadedScene& shown =
          scenes.load(experiment.reference_file(run), view_of(run.config), environment);
      check_limits(context, shown.scene, reference_spec(run.config, shown.hash).settings);
    } catch (const Error& error) {
      fail("{}: run '{}': {}", experiment.file.string(), run.id, error.what());
    }
  }
}

bool run_experiment(const Experiment& experiment, gpu::Context& context, SceneStore& scenes,
                    const RunChoices& choices, const Stopper& stopper, const GiveUp& give_up,
                    Progress& progress) {
  const std::filesystem::path folder = choices.root / experiment.name;
  if (!choices.fresh) keep_choices_of(context, folder, !choices.shard.is_whole());
  return Work(experiment, context, scenes, choices, stopper, give_up, progress).run();
}

}  // namespace qtrace::experiments
