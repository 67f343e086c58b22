#include "experiments/records/records.h"

namespace qtrace::experiments {
namespace {

std::vector<double> counted(const std::vector<FrameRecord>& frames, double FrameRecord::*time) {
  std::vector<double> values;
  for (const FrameRecord& frame : frames) {
    if (!frame.is_warmup) values.push_back(frame.*time);
  }
  return values;
}

}  // namespace

std::vector<double> RunRecord::host_ms() const { return counted(frames, &FrameRecord::host_ms); }

std::vector<double> RunRecord::gpu_ms() const { return counted(frames, &FrameRecord::gpu_ms); }

FrameCounters RunRecord::totals() const {
  FrameCounters total;
  for (const FrameRecord& frame : frames) total += frame.counters;
  return total;
}

const SnapshotRecord* RunRecord::last_snapshot() const {
  const bool counts = status == RunStatus::finished || status == RunStatus::partial;
  return counts && !snapshots.empty() ? &snapshots.back() : nullptr;
}

const ErrorMetrics* RunRecord::final_errors() const {
  const SnapshotRecord* last = last_snapshot();
  return last == nullptr ? nullptr : &last->errors;
}

const FilteredRecord* RunRecord::final_filtered() const {
  const SnapshotRecord* last = last_snapshot();
  return last == nullptr || !last->filtered ? nullptr : &*last->filtered;
}

std::optional<double> RunRecord::relmse_x_seconds() const {
  const ErrorMetrics* errors = final_errors();
  if (errors == nullptr) return std::nullopt;
  return errors->relmse * elapsed_s();
}

std::optional<double> RunRecord::fireflies_per_million() const {
  const FrameCounters total = totals();
  if (total.paths == 0) return std::nullopt;
  return 1e6 * static_cast<double>(total.fireflies) / static_cast<double>(total.paths);
}

void RunRecord::end_at_last_snapshot() {
  if (!snapshots.empty()) frames.resize(static_cast<std::size_t>(snapshots.back().frame));
}

}  // namespace qtrace::experiments
