// What is measured of a run.
#pragma once

#include "engine/tracer/counters.h"
#include "experiments/config/experiment_config.h"
#include "experiments/measure/metrics.h"
#include "experiments/records/run_status.h"

#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// One frame. Times hold render_frame() alone, learning included; no readback, no metrics, no files.
struct FrameRecord {
  int frame = 0;           // 1-based
  bool is_warmup = false;  // left out of medians, kept in totals
  double host_ms = 0;      // host clock around the frame and the end of its work
  double gpu_ms = 0;       // GL timer queries around the frame
  double elapsed_s = 0;    // sum of host times so far
  double gpu_elapsed_s = 0;
  FrameCounters counters;
};

// A filtered copy of a snapshot: biased, so its errors are never mixed with the others.
struct FilteredRecord {
  ErrorMetrics errors;
  double filter_ms = 0;  // host clock: upload, passes and readback; in no time of a frame
};

// The running mean after a frame, against the reference.
struct SnapshotRecord {
  int frame = 0;  // also the samples per pixel
  double elapsed_s = 0;
  double gpu_elapsed_s = 0;
  ErrorMetrics errors;
  std::uint64_t non_finite = 0;  // samples so far
  std::uint64_t clamped_samples = 0;
  double clamp_bias = 0;  // what clamping added to the mean over pixels and channels: never positive
  std::optional<FilteredRecord> filtered;
};

// The fireflies of a run; their number is among the counters of its frames.
struct FireflyRecord {
  std::optional<double> energy_fraction;  // of all radiance summed; nothing for black images
  std::optional<double> brightest;        // radiance
};

// One run; what it did not reach stays empty.
struct RunRecord {
  Run run;
  std::string scene;  // file name without folder and extension
  RunStatus status = RunStatus::waiting;
  std::string reason;     // of a failure
  std::size_t place = 0;  // among the runs of the config
  int order = 0;          // of execution, from 1
  std::string started;    // UTC
  std::string reference_hash;
  std::string config_hash;
  double setup_s = 0;  // acceleration, cells, shaders: before the first frame, not in elapsed_s
  std::vector<FrameRecord> frames;
  std::vector<SnapshotRecord> snapshots;
  FireflyRecord fireflies;
  std::optional<Verdict> verdict;  // nothing where nothing was expected or the run did not finish
  std::optional<std::uint32_t> table_given_up;  // after which frame (rl.trial_frames); 0: before the first
  bool light_paths_given_up = false;  // before the first frame (light_path_trial)

  std::vector<double> host_ms() const;  // without warm-up frames
  std::vector<double> gpu_ms() const;
  double elapsed_s() const { return frames.empty() ? 0 : frames.back().elapsed_s; }
  double gpu_elapsed_s() const { return frames.empty() ? 0 : frames.back().gpu_elapsed_s; }
  FrameCounters totals() const;
  // Forgets the frames after it, so that errors and times belong together where a run was stopped between
  // two.
  void end_at_last_snapshot();
  const SnapshotRecord* last_snapshot() const;          // null unless finished or partial
  const ErrorMetrics* final_errors() const;             // of it
  const FilteredRecord* final_filtered() const;         // of it; null where nothing was filtered
  std::optional<double> relmse_x_seconds() const;       // inefficiency: final relmse * elapsed_s
  std::optional<double> fireflies_per_million() const;  // samples
};

}  // namespace qtrace::experiments
