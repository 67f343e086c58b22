#include "experiments/run.h"

#include "engine/gpu/timer.h"
#include "engine/tracer/atrous.h"
#include "engine/tracer/tracer.h"
#include "experiments/fireflies.h"
#include "experiments/flip.h"
#include "experiments/hash.h"
#include "experiments/manifest.h"
#include "experiments/version.h"

#include <algorithm>
#include <chrono>

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

// A run in progress: its record, its manifest and its files, kept in step.
class Execution {
 public:
  Execution(const RunJob& job, RunRecord& record)
      : job_(job),
        record_(record),
        files_(job.make_files(job.folder, metadata())),
        manifest_(first_manifest()) {
    files_->write_manifest(manifest_);
  }

  void run(Progress& progress) {
    const auto reference = job_.get_reference();
    manifest_["reference"] = reference_json(*reference);
    if (const std::string warning = noise_warning(*reference); !warning.empty()) {
      manifest_["warnings"].push_back(warning);
    }
    progress.begin(job_.label, config().frames, run_work(config()) / config().frames);
    begun_ = true;
    const auto start = Clock::now();
    Tracer tracer(job_.context, job_.scene.scene, config().render);
    record_.setup_s = seconds_since(start);
    manifest_["cells"] = tracer.cells();
    manifest_["device_bytes"] = tracer.device_bytes();
    for (const std::string& warning : tracer.warnings()) warn(warning, progress);
    const FirstHitImage first_hit = tracer.first_hit();
    files_->write_first_hit(to_world(first_hit, job_.scene.scene.origin));
    if (config().filter.kind == FilterKind::atrous) {
      filter_.emplace(job_.context, first_hit, config().filter);
    }
    tracer.set_firefly_thresholds(firefly_thresholds(reference->image, config().firefly_multiple));
    if (saves_table()) prepare_table(tracer.table(), progress);
    render(tracer, *reference, progress);
    judge_image(tracer.radiance(), *reference);
  }

  bool begun() const { return begun_; }

  // Writes what was measured and closes the manifest.
  void close(const std::string& status, const std::string& reason) {
    record_.status = status;
    record_.reason = reason;
    manifest_["status"] = status;
    if (!reason.empty()) manifest_["reason"] = reason;
    manifest_["ended"] = utc_now();
    manifest_["frames"] = record_.frames.size();
    manifest_["setup_s"] = record_.setup_s;
    manifest_["elapsed_s"] = record_.elapsed_s();
    manifest_["gpu_elapsed_s"] = record_.gpu_elapsed_s();
    manifest_["non_finite"] = record_.totals().non_finite;
    files_->write_tables(record_);
    files_->write_manifest(manifest_);
  }

 private:
  const RunConfig& config() const { return job_.run.config; }

  ExrMetadata metadata() const {
    return {{"seed", std::to_string(config().render.seed)},
            {"configHash", record_.config_hash},
            {"software", software()}};
  }

  Json first_manifest() const {
    Json axes = Json::object();
    for (std::size_t i = 0; i < job_.experiment.axes.size(); ++i) {
      axes[job_.experiment.axes[i].name] = job_.run.labels[i];
    }
    Json manifest{{"status", "running"},
                  {"experiment", job_.experiment.name},
                  {"run", job_.run.id},
                  {"cell", job_.run.cell},
                  {"axes", axes},
                  {"config", write_knobs(config())},
                  {"config_hash", record_.config_hash},
                  {"scene", scene_json(job_.scene)},
                  {"reference", {{"hash", record_.reference_hash}}},
                  {"device", device_json(job_.context.device())},
                  {"program", program_json()},
                  {"metrics", metrics_json()},
                  {"timing", timing_note()},
                  {"started", record_.started},
                  {"warnings", Json::array()}};
    const std::string warning = light_warning(job_.scene, config());
    if (!warning.empty()) manifest["warnings"].push_back(warning);
    return manifest;
  }

  void render(Tracer& tracer, const Reference& reference, Progress& progress) {
    const std::vector<int> snapshots = config().snapshots.resolve(config().frames);
    gpu::Timer timer;
    std::optional<double> relmse;
    for (int frame = 1; frame <= config().frames; ++frame) {
      measure_frame(frame, tracer, timer);
      if (std::binary_search(snapshots.begin(), snapshots.end(), frame)) {
        relmse = take_snapshot(frame, tracer, reference);
      }
      progress.step(frame, relmse);
    }
    note_non_finite(tracer, progress);
    const Outliers outliers = tracer.outliers();
    record_.fireflies = firefly_record(outliers, tracer.radiance());
    manifest_["brightest_fireflies"] = brightest_fireflies(outliers, reference.image);
  }

  void measure_frame(int frame, Tracer& tracer, gpu::Timer& timer) {
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
    next.statistics = tracer.last_frame_statistics();
    record_.frames.push_back(next);
  }

  bool saves_table() const { return config().save_table != SaveTable::none; }

  void prepare_table(const QTable* table, Progress& progress) {
    if (table != nullptr) {
      files_->write_cells(*table, job_.scene.scene.origin);
    } else {
      warn(fmt::format(
               "save_table is {}, but there is nothing to save: neither directions nor lights are learned",
               enum_name(config().save_table)),
           progress);
    }
  }

  void save_table(int frame, const QTable* table) const {
    const bool wanted = config().save_table == SaveTable::snapshots || frame == config().frames;
    if (wanted && table != nullptr) files_->write_q_table(frame, *table);
  }

  ErrorMetrics measure(const RadianceImage& image, const Reference& reference) const {
    ErrorMetrics errors = compare_images(image, reference.image);
    if (config().flip) errors.flip = flip_error(image, reference.image);
    return errors;
  }

  double take_snapshot(int frame, Tracer& tracer, const Reference& reference) {
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

  void judge_image(const RadianceImage& image, const Reference& reference) {
    const std::uint64_t non_finite = record_.totals().non_finite + reference.non_finite;
    record_.verdict = judge(config().expect, image, reference.image, non_finite);
    if (!record_.verdict) return;
    manifest_["verdict"] = record_.verdict->word;
    if (!record_.verdict->reason.empty()) manifest_["verdict_reason"] = record_.verdict->reason;
  }

  void note_non_finite(const Tracer& tracer, Progress& progress) {
    Json samples = Json::array();
    for (const NonFiniteSample& sample : tracer.non_finite_samples()) {
      samples.push_back({{"x", sample.x}, {"y", sample.y}, {"frame", sample.frame}});
    }
    manifest_["non_finite_samples"] = samples;
    const std::uint64_t count = record_.totals().non_finite;
    if (count == 0) return;
    warn(fmt::format("{} samples were not finite and count as 0; manifest.json names pixels and frames",
                     count),
         progress);
  }

  void warn(const std::string& warning, Progress& progress) {
    manifest_["warnings"].push_back(warning);
    progress.warning(job_.run.id + ": " + warning);
  }

  const RunJob& job_;
  RunRecord& record_;
  std::unique_ptr<RunFiles> files_;
  Json manifest_;
  std::optional<AtrousFilter> filter_;
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<RunFiles> make_run_files(const std::filesystem::path& folder, const ExrMetadata& metadata) {
  return std::make_unique<RunFiles>(folder, metadata);
}

double run_work(const RunConfig& config) {
  return static_cast<double>(config.render.width) * config.render.height * config.frames;
}

RunRecord execute_run(const RunJob& job, Progress& progress) {
  RunRecord record;
  record.run = job.run;
  record.scene = job.scene.scene.name;
  record.status = "running";
  record.started = utc_now();
  record.config_hash = config_hash(job.run.config, job.scene.hash);
  record.reference_hash = reference_spec(job.run.config, job.reference_scene_hash).hash;
  std::optional<Execution> execution;
  try {
    execution.emplace(job, record);
    execution->run(progress);
    execution->close("finished", "");
  } catch (const std::exception& error) {
    record.status = "failed";
    record.reason = error.what();
    try {
      if (execution) execution->close("failed", record.reason);
    } catch (const std::exception& second) {
      progress.warning(fmt::format("{}: {}", job.run.id, second.what()));
    }
  }
  if (execution && execution->begun()) {
    progress.end();
  } else {
    progress.plan(-run_work(job.run.config));  // nothing of it will be done
  }
  return record;
}

std::string light_warning(const LoadedScene& scene, const RunConfig& config) {
  const auto& environment = config.render.environment;
  const bool lit = has_light(scene.scene) || *std::max_element(environment.begin(), environment.end()) > 0;
  return lit ? "" : fmt::format("{}: the scene has no light: the image will be black", scene.file.string());
}

}  // namespace qtrace::experiments
