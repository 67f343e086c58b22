#include "experiments/run/run.h"

#include "engine/gpu/timer.h"
#include "engine/tracer/atrous.h"
#include "engine/tracer/tracer.h"
#include "experiments/files/atomic_file.h"
#include "experiments/images/exr_images.h"
#include "experiments/measure/flip.h"
#include "experiments/records/figures.h"
#include "experiments/records/fireflies.h"
#include "experiments/run/run_store.h"
#include "experiments/runtime/manifest.h"
#include "experiments/runtime/version.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace qtrace::experiments {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Positions as the scene's file has them.
FirstHitImage to_world(FirstHitImage image, const glm::dvec3& origin) {
  for (std::size_t i = 0; i < image.position.size(); ++i) {
    const bool is_hit = image.normal[i] != glm::vec3(0.0F);
    if (is_hit) image.position[i] = glm::vec3(glm::dvec3(image.position[i]) + origin);
  }
  return image;
}

// What the run's manifest says before its first frame.
Json first_manifest(const RunJob& job, const RunRecord& record) {
  const RunConfig& config = job.run.config;
  Json axes = Json::object();
  for (std::size_t i = 0; i < job.experiment.axes.size(); ++i) {
    axes[job.experiment.axes[i].name] = job.run.labels[i];
  }
  Json manifest{{"schema", kResultsSchema},
                {"status", enum_name(RunStatus::running)},
                {"experiment", job.experiment.name},
                {"config_file", job.experiment.file.string()},
                {"run", job.run.id},
                {"configuration", job.run.configuration},
                {"axes", axes},
                {"config", write_knobs(config)},
                {"config_hash", record.config_hash},
                {"scene", scene_json(*job.inputs.scene, job.folder)},
                {"reference", {{"hash", record.reference_hash}}},
                {"reference_scene", scene_json(*job.inputs.shown, job.folder)},
                {"device", device_json(job.context.device())},
                {"program", program_json()},
                {"metrics", figures_json()},
                {"variance", variance_note(config.render)},
                {"timing", timing_note()},
                {"started", record.started},
                {"warnings", Json::array()}};
  const std::string warning = light_warning(*job.inputs.scene, config);
  if (!warning.empty()) manifest["warnings"].push_back(warning);
  return manifest;
}

Json trial_json(const Trial& trial) {
  const Trial::Finding& found = *trial.finding();
  return {{"gain", found.gain},
          {"gain_error", found.gain_error},
          {"found", found.found},
          {"work", found.work},
          {"needed", found.needed},
          {"frame", found.frame},
          {"decided", trial.is_decided()},
          {"given_up", trial.gave_up()}};
}

std::string why_given_up(const Trial::Finding& found, std::string_view tried) {
  return fmt::format(
      "frames without {0} had {1:.3g} times the error of those with {0}, which take {2:.3g} times the "
      "work, and {3:.3g} times would pay for that",
      tried, found.gain, found.work, found.needed);
}

// A run in progress: its record, its manifest and its files, kept in step.
class Execution {
 public:
  Execution(const RunJob& job, RunRecord& record);

  // Renders up to the job's last frame, from the checkpoint where there is one. Throws what the run fails by,
  // Stopped, and gpu::ContextLost.
  void run(Progress& progress);

  bool begun() const { return begun_; }
  int frames() const { return static_cast<int>(record_.frames.size()); }  // that are done

  // What was measured is written, and the manifest closed: a run has ended only when that says so.
  void close(RunStatus status, const std::string& reason);

 private:
  const RunConfig& config() const { return job_.run.config; }
  ExrMetadata metadata() const;
  int last_frame() const;
  bool saves_table() const { return config().save_table != SaveTable::none; }

  void adopt(RunRecord earlier);
  void prepare(Tracer& tracer, const Reference& reference, Progress& progress);
  void prepare_table(const QTable* table, Progress& progress);
  void render(Tracer& tracer, const Reference& reference, Progress& progress);
  void render_frame(int frame, Tracer& tracer, gpu::Timer& timer);
  void measure_frame(int frame, Tracer& tracer, gpu::Timer& timer);
  void fail_late(int frame);
  double take_snapshot(int frame, Tracer& tracer, const Reference& reference);
  ErrorMetrics measure(const RadianceImage& image, const Reference& reference) const;
  void save_table(int frame, const QTable* table) const;
  void save_checkpoint(const Tracer& tracer);
  void finish(Tracer& tracer, const Reference& reference, Progress& progress);
  void judge_image(const RadianceImage& image, const Reference& reference);
  void note_non_finite(const Tracer& tracer, Progress& progress);
  void note_table_trial(const Trial& trial, Progress& progress);
  void note_light_path_trial(const Trial& trial, Progress& progress);
  void warn(const std::string& warning, Progress& progress);

  const RunJob& job_;
  RunRecord& record_;
  std::unique_ptr<RunFiles> files_;
  RunStore store_;
  Json manifest_;
  std::optional<AtrousFilter> filter_;
  bool begun_ = false;
};

Execution::Execution(const RunJob& job, RunRecord& record)
    : job_(job),
      record_(record),
      files_(job.make_files(job.folder, metadata(), job.files)),
      store_(job.folder, job.inputs.identity),
      manifest_(first_manifest(job, record)) {}

void Execution::run(Progress& progress) {
  auto checkpoint = store_.read_checkpoint([&](const Error& error) {
    progress.warning(fmt::format("this checkpoint cannot be used, so its run starts anew: {}", error.what()));
  });
  if (checkpoint) adopt(std::move(checkpoint->record));
  files_->write_manifest(manifest_);
  const auto reference = job_.get_reference();
  manifest_["reference"] = reference_json(*reference);
  if (const std::string warning = noise_warning(*reference); !warning.empty()) {
    manifest_["warnings"].push_back(warning);
  }
  progress.begin(job_.label, last_frame(), run_work(config()) / config().frames, frames());
  begun_ = true;
  const auto start = Clock::now();
  Tracer tracer(job_.context, job_.inputs.scene->scene, config().render);
  if (!checkpoint) record_.setup_s = seconds_since(start);
  prepare(tracer, *reference, progress);
  if (checkpoint) tracer.restore(checkpoint->state);
  checkpoint.reset();  // as large as the tracer's buffers
  render(tracer, *reference, progress);
  if (frames() == config().frames) finish(tracer, *reference, progress);
}

// What was measured is written, and the manifest closed: a run has ended only when that says so.
void Execution::close(RunStatus status, const std::string& reason) {
  record_.status = status;
  record_.reason = reason;
  manifest_["status"] = enum_name(status);
  if (!reason.empty()) manifest_["reason"] = reason;
  if (status != RunStatus::partial) manifest_["ended"] = utc_now();
  manifest_["frames"] = record_.frames.size();
  manifest_["setup_s"] = record_.setup_s;
  manifest_["elapsed_s"] = record_.elapsed_s();
  manifest_["gpu_elapsed_s"] = record_.gpu_elapsed_s();
  manifest_["non_finite"] = record_.totals().non_finite;
  files_->write_tables(record_);
  if (status != RunStatus::partial) store_.write_record(job_.files, record_);
  files_->write_manifest(manifest_);
  if (status == RunStatus::finished) store_.remove_checkpoint(job_.files);
}

ExrMetadata Execution::metadata() const {
  return {{"seed", std::to_string(config().render.seed)},
          {"configHash", record_.config_hash},
          {kVarianceNote, variance_note(config().render)},
          {"software", software()}};
}

int Execution::last_frame() const {
  return job_.until > 0 ? std::min(job_.until, config().frames) : config().frames;
}

// What was measured before the run was interrupted.
void Execution::adopt(RunRecord earlier) {
  earlier.run = record_.run;
  record_ = std::move(earlier);
  record_.status = RunStatus::running;
  manifest_["started"] = record_.started;
  manifest_["resumed_after_frame"] = frames();
}

void Execution::render(Tracer& tracer, const Reference& reference, Progress& progress) {
  const std::vector<int> snapshots = config().snapshots.resolve(config().frames);
  gpu::Timer timer;
  std::optional<double> relmse;
  Clock::time_point saved = Clock::now();
  for (int frame = frames() + 1; frame <= last_frame(); ++frame) {
    render_frame(frame, tracer, timer);
    job_.context.check_alive();
    if (std::binary_search(snapshots.begin(), snapshots.end(), frame)) {
      relmse = take_snapshot(frame, tracer, reference);
    }
    progress.step(frame, relmse);
    if (frame == config().frames) return;
    const auto stopped = job_.stopper == nullptr ? std::nullopt : job_.stopper->reason();
    if (stopped || frame == last_frame() || seconds_since(saved) >= config().checkpoint_s) {
      save_checkpoint(tracer);
      saved = Clock::now();
    }
    if (stopped) throw *stopped;
  }
}

void Execution::render_frame(int frame, Tracer& tracer, gpu::Timer& timer) {
  const WatchedTime watched(job_.watchdog, config().frame_timeout_s, [this, frame] { fail_late(frame); });
  measure_frame(frame, tracer, timer);
}

// On the watchdog's thread, while the run's own hangs in the driver.
void Execution::fail_late(int frame) {
  std::string why =
      fmt::format("frame {} took longer than frame_timeout_s, {:g} s", frame, config().frame_timeout_s);
  try {
    close(RunStatus::failed, why);
    job_.files.flush();
  } catch (const std::exception& error) {
    why += fmt::format("; {}", error.what());
  }
  job_.give_up(fmt::format("{}: failed: {}", job_.label, why));
}

void Execution::save_checkpoint(const Tracer& tracer) {
  store_.write_checkpoint(job_.files, record_, tracer.state());
  manifest_["checkpoint_frame"] = frames();
  files_->write_manifest(manifest_);
}

void Execution::note_table_trial(const Trial& trial, Progress& progress) {
  if (!trial.finding()) return;
  manifest_["table_trial"] = trial_json(trial);
  if (!trial.gave_up()) return;
  const std::uint32_t frame = trial.finding()->frame;
  record_.table_given_up = frame;
  const std::string frames = frame == 0 ? "all frames" : fmt::format("after frame {} directions", frame);
  warn(fmt::format("{} went without the table: {} (rl.trial_frames)", frames,
                   why_given_up(*trial.finding(), "it")),
       progress);
}

void Execution::note_light_path_trial(const Trial& trial, Progress& progress) {
  if (!trial.finding()) return;
  manifest_["light_path_trial"] = trial_json(trial);
  record_.light_paths_given_up = trial.gave_up();
  if (!trial.gave_up()) return;
  warn(fmt::format("all frames went without light paths: {} (light_path_trial)",
                   why_given_up(*trial.finding(), "them")),
       progress);
}

void Execution::finish(Tracer& tracer, const Reference& reference, Progress& progress) {
  note_table_trial(tracer.table_trial(), progress);
  note_light_path_trial(tracer.light_path_trial(), progress);
  judge_image(tracer.radiance(), reference);
  note_non_finite(tracer, progress);
  const Outliers outliers = tracer.outliers();
  record_.fireflies = firefly_record(outliers, tracer.radiance());
  manifest_["brightest_fireflies"] = brightest_fireflies(outliers, reference.image);
}

void Execution::measure_frame(int frame, Tracer& tracer, gpu::Timer& timer) {
  FrameRecord next;
  next.frame = frame;
  next.is_warmup = frame <= config().warmup_frames;
  const auto start = Clock::now();
  timer.start();
  tracer.render_frame();
  timer.stop();
  job_.context.finish();
  next.host_ms = seconds_since(start) * 1e3;
  next.gpu_ms = timer.milliseconds();
  next.elapsed_s = record_.elapsed_s() + next.host_ms / 1e3;
  next.gpu_elapsed_s = record_.gpu_elapsed_s() + next.gpu_ms / 1e3;
  next.counters = tracer.last_frame_counters();
  record_.frames.push_back(next);
}

// What is known before the first frame.
void Execution::prepare(Tracer& tracer, const Reference& reference, Progress& progress) {
  manifest_["cells"] = tracer.cells();
  manifest_["device_bytes"] = tracer.device_bytes();
  for (const std::string& warning : tracer.warnings()) warn(warning, progress);
  const FirstHitImage first_hit = tracer.first_hit();
  files_->write_first_hit(to_world(first_hit, job_.inputs.scene->scene.origin));
  if (config().filter.kind == FilterKind::atrous) {
    filter_.emplace(job_.context, first_hit, config().filter);
  }
  tracer.set_firefly_thresholds(firefly_thresholds(reference.image, config().firefly_multiple));
  if (saves_table()) prepare_table(tracer.table(), progress);
}

void Execution::prepare_table(const QTable* table, Progress& progress) {
  if (table != nullptr) {
    files_->write_cells(*table, job_.inputs.scene->scene.origin);
  } else {
    warn(fmt::format(
             "save_table is {}, but there is nothing to save: neither directions nor lights are learned",
             enum_name(config().save_table)),
         progress);
  }
}

void Execution::save_table(int frame, const QTable* table) const {
  const bool wanted = config().save_table == SaveTable::snapshots || frame == config().frames;
  if (wanted && table != nullptr) files_->write_q_table(frame, *table);
}

ErrorMetrics Execution::measure(const RadianceImage& image, const Reference& reference) const {
  ErrorMetrics errors = compare_images(image, reference.image);
  if (config().flip) errors.flip = flip_error(image, reference.image);
  return errors;
}

double Execution::take_snapshot(int frame, Tracer& tracer, const Reference& reference) {
  const RadianceImage image = tracer.radiance();
  SnapshotRecord next;
  next.frame = frame;
  next.elapsed_s = record_.elapsed_s();
  next.gpu_elapsed_s = record_.gpu_elapsed_s();
  next.errors = measure(image, reference);
  next.non_finite = record_.totals().non_finite;
  next.clamped_samples = record_.totals().clamped_samples;
  next.clamp_bias = clamp_bias(tracer.outliers(), image);
  std::optional<RadianceImage> filtered;
  if (filter_) {
    const auto start = Clock::now();
    filtered = filter_->apply(image);
    const double ms = seconds_since(start) * 1e3;
    next.filtered = FilteredRecord{measure(*filtered, reference), ms};
  }
  record_.snapshots.push_back(next);
  files_->write_snapshot(frame, image, filtered ? &*filtered : nullptr);
  if (saves_table()) save_table(frame, tracer.table());
  files_->write_tables(record_);
  return next.errors.relmse;
}

void Execution::judge_image(const RadianceImage& image, const Reference& reference) {
  const std::uint64_t non_finite = record_.totals().non_finite + reference.non_finite;
  record_.verdict = judge(config().expect, image, reference.image, non_finite);
  if (!record_.verdict) return;
  manifest_["verdict"] = record_.verdict->word;
  if (!record_.verdict->reason.empty()) manifest_["verdict_reason"] = record_.verdict->reason;
}

void Execution::note_non_finite(const Tracer& tracer, Progress& progress) {
  Json samples = Json::array();
  for (const NonFiniteSample& sample : tracer.non_finite_samples()) {
    samples.push_back({{"x", sample.x}, {"y", sample.y}, {"frame", sample.frame}});
  }
  manifest_["non_finite_samples"] = samples;
  const std::uint64_t count = record_.totals().non_finite;
  if (count == 0) return;
  warn(fmt::format("{} samples were not finite and count as 0; manifest.json names pixels and frames", count),
       progress);
}

void Execution::warn(const std::string& warning, Progress& progress) {
  manifest_["warnings"].push_back(warning);
  progress.warning(job_.run.id + ": " + warning);
}

}  // namespace

std::string light_warning(const LoadedScene& scene, const RunConfig& config) {
  const auto& environment = config.render.environment;
  const bool lit = has_light(scene.scene) || *std::max_element(environment.begin(), environment.end()) > 0;
  return lit ? ""
             : fmt::format(
                   "{}: the scene has no light: the image will be black; key 'environment' gives it a sky, "
                   "as "
                   "[1, 1, 1]",
                   scene.file.string());
}

std::unique_ptr<RunFiles> make_run_files(const std::filesystem::path& folder, const ExrMetadata& metadata,
                                         FileQueue& files) {
  return std::make_unique<RunFiles>(folder, metadata, files);
}

double run_work(const RunConfig& config) {
  return static_cast<double>(config.render.width) * config.render.height * config.frames;
}

RunEnd execute_run(const RunJob& job, Progress& progress) {
  RunEnd result;
  RunRecord& record = result.record;
  record.run = job.run;
  record.scene = job.inputs.scene->scene.name;
  record.status = RunStatus::running;
  record.started = utc_now();
  record.config_hash = job.inputs.config_hash;
  record.reference_hash = job.inputs.reference_hash;
  std::optional<Execution> execution;
  const auto close = [&](RunStatus status, const std::string& reason) {
    record.status = status;
    record.reason = reason;
    try {
      if (execution) execution->close(status, reason);
    } catch (const std::exception& error) {
      progress.warning(fmt::format("{}: {}", job.run.id, error.what()));
    }
  };
  const auto end = [&] {
    if (execution && execution->begun()) return progress.end();
    progress.plan(-run_work(job.run.config));  // nothing of it will be done
  };
  try {
    execution.emplace(job, record);
    execution->run(progress);
    const bool is_whole = execution->frames() == job.run.config.frames;
    execution->close(is_whole ? RunStatus::finished : RunStatus::partial, "");
  } catch (const Stopped& stopped) {
    close(RunStatus::partial, stopped.why);
    result.stopped = stopped;
  } catch (const DiskFull& error) {
    close(RunStatus::partial, error.what());
    result.stopped = Stopped{error.what(), 1};
  } catch (const gpu::ContextLost&) {
    progress.end();
    throw;
  } catch (const std::exception& error) {
    close(RunStatus::failed, error.what());
  }
  end();
  return result;
}

}  // namespace qtrace::experiments
