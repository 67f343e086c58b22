// What the times of a run's frames say about the machine: whether it had warmed up, whether it was quiet.
#pragma once

#include "experiments/records/records.h"

#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

constexpr double kWarmupDeviations = 5;   // from the median of the second half, in scaled MADs ...
constexpr double kWarmupFraction = 0.05;  // ... and at least this share of that median
constexpr double kNoisyFraction = 0.1;    // a run is noisy above this interquartile range / median
constexpr double kOutlierDeviations =
    14.826;                             // hyperfine's: modified z-score above 10 / 0.6745, in scaled MADs ...
constexpr double kNoisyOutliers = 0.1;  // ... for more than this share of the frames
constexpr std::size_t kFewestFrames = 8;  // fewer say nothing

// Milliseconds per million rays of every frame, by the host clock: paths grow longer or shorter as a table is
// learned, which is work and not noise. So is teaching the table, or leaving it out: times of frames that do
// so are scaled to the median of the others. Frames without rays are left out.
std::vector<double> times_per_ray(const RunRecord& record);

// The same without warm-up, neither what warmup_frames says nor the slow first frames: what noise is judged
// by.
std::vector<double> settled_times(const RunRecord& record);

// How many frames at the start are slower than the rest: all before the first that is within the limits
// above. Nothing for fewer than kFewestFrames.
std::optional<int> slow_first_frames(const std::vector<double>& times);

// Nothing for fewer than kFewestFrames.
std::optional<bool> is_noisy(const std::vector<double>& times);

// (3rd - 1st quartile) / median. Nothing for no values.
std::optional<double> relative_spread(const std::vector<double>& times);

// At most two sentences about all runs together, each with what to do; empty where all is well.
std::string time_warnings(const std::vector<RunRecord>& records);

}  // namespace qtrace::experiments
