// Configurations of a sweep (not of a Q-table): runs that differ in their seed alone, taken together.
#pragma once

#include "experiments/measure/error_parts.h"
#include "experiments/measure/statistics.h"
#include "experiments/records/figures.h"
#include "experiments/records/records.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// Middle and spread of the frames of all seeds that count.
struct FrameTimes {
  double median = 0;
  double p10 = 0;
  double p90 = 0;
};

// Estimates are over the finished seeds; where none finished, over those partial ones that came furthest;
// else empty.
struct Configuration {
  std::string name;  // axis labels but the seed, joined by " / "
  std::string scene;
  std::vector<std::string> labels;  // one per axis, of the first run
  int frames = 0;                   // of the seeds that count
  int planned_frames = 0;           // more, where these are partial
  double clamp_radiance = 0;        // 0: nothing was clamped
  std::size_t runs = 0;
  std::size_t finished = 0;  // those that count
  std::optional<FrameTimes> host_ms;
  std::optional<FrameTimes> gpu_ms;
  std::uint64_t clamped_samples = 0;
  std::uint64_t non_finite = 0;
  std::size_t at_reference_floor = 0;           // seeds
  std::map<std::string, std::size_t> verdicts;  // seeds by word; empty where nothing was expected
  std::vector<const RunRecord*>
      members;                      // those that count, among the records that the configuration is made of
  std::optional<ErrorParts> parts;  // filled in from the images when all runs are done
  std::map<std::string, Estimate> figures;  // by column of summary.csv; a seed without a value is not in it

  std::optional<Estimate> figure(const std::string& column) const;  // nothing where no seed has a value
};

// In the order of their first runs.
std::vector<Configuration> collect_configurations(const std::vector<RunRecord>& records);

}  // namespace qtrace::experiments
