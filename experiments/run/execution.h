// A run in progress: its record, its manifest and its files, kept in step.
#pragma once

#include "engine/gpu/timer.h"
#include "engine/tracer/atrous.h"
#include "engine/tracer/tracer.h"
#include "experiments/run/run.h"
#include "experiments/run/run_store.h"

#include <memory>
#include <optional>
#include <string>

namespace qtrace::experiments {

class Execution {
 public:
  Execution(const RunJob& job, RunRecord& record);

  // Renders up to the job's last frame, from the checkpoint where there is one. Throws what the run fails by,
  // Stopped, and gpu::ContextLost.
  void run(Progress& progress);

  bool begun() const { return begun_; }
  int frames() const { return static_cast<int>(record_.frames.size()); }  // that are done

  // What was measured is written, and the manifest closed: a run has ended only when that says so.
  void close(const std::string& status, const std::string& reason);

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
  void note_trial(const Tracer& tracer, Progress& progress);
  void warn(const std::string& warning, Progress& progress);

  const RunJob& job_;
  RunRecord& record_;
  std::unique_ptr<RunFiles> files_;
  RunStore store_;
  Json manifest_;
  std::optional<AtrousFilter> filter_;
  bool begun_ = false;
};

}  // namespace qtrace::experiments
