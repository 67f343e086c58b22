#include "experiments/records/frame_times.h"

#include "experiments/measure/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace qtrace::experiments {
namespace {

constexpr double kScaledMad = 1.4826;  // makes the MAD of a normal distribution its standard deviation

double median(const std::vector<double>& values) { return *quantile(values, 0.5); }

double scaled_mad(const std::vector<double>& values, double middle) {
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - middle));
  return kScaledMad * median(distances);
}

// Whether a frame asked the table, and whether it taught it: each costs time.
using Work = std::pair<bool, bool>;

Work work_of(const FrameRecord& frame) {
  return {frame.counters.cell_lookups > 0, frame.counters.table_updates > 0};
}

std::string noise_warning(const std::vector<RunRecord>& records) {
  std::size_t noisy = 0, judged = 0;
  const RunRecord* worst = nullptr;
  double worst_spread = 0;
  for (const RunRecord& record : records) {
    const std::vector<double> times = settled_times(record);
    const auto answer = is_noisy(times);
    if (!answer) continue;
    ++judged;
    if (!*answer) continue;
    ++noisy;
    const double spread = *relative_spread(times);
    if (worst != nullptr && spread <= worst_spread) continue;
    worst = &record;
    worst_spread = spread;
  }
  if (worst == nullptr) return "";
  return fmt::format(
      "The machine was noisy in {} of {} runs (frame times per ray: interquartile range above {:g} % of the "
      "median, or more than {:g} % outliers; worst {} with {:.3g} %): close other programs, raise frames or "
      "seeds, "
      "and rather read ratios, as configurations took turns.",
      noisy, judged, 100 * kNoisyFraction, 100 * kNoisyOutliers, worst->run.id, 100 * worst_spread);
}

std::string warmup_warning(const std::vector<RunRecord>& records) {
  std::size_t late = 0;
  int longest = 0;
  for (const RunRecord& record : records) {
    const int slow = slow_first_frames(times_per_ray(record)).value_or(0);
    if (slow <= record.run.config.warmup_frames) continue;
    ++late;
    longest = std::max(longest, slow);
  }
  if (late == 0) return "";
  return fmt::format(
      "{} runs had more slow frames at their start than warmup_frames leaves out of the medians (up to {}): "
      "raise "
      "warmup_frames to {}.",
      late, longest, longest);
}

}  // namespace

std::vector<double> times_per_ray(const RunRecord& record) {
  std::vector<double> times;
  std::map<Work, std::vector<double>> by_work;
  for (const FrameRecord& frame : record.frames) {
    if (frame.counters.rays == 0) continue;
    times.push_back(frame.host_ms * 1e6 / static_cast<double>(frame.counters.rays));
    by_work[work_of(frame)].push_back(times.back());
  }
  if (by_work.size() < 2) return times;
  const double usual = median(
      std::ranges::max_element(by_work, {}, [](const auto& kind) { return kind.second.size(); })->second);
  auto time = times.begin();
  for (const FrameRecord& frame : record.frames) {
    if (frame.counters.rays != 0) *time++ *= usual / median(by_work.at(work_of(frame)));
  }
  return times;
}

std::vector<double> settled_times(const RunRecord& record) {
  std::vector<double> times = times_per_ray(record);
  const auto warmup = std::ranges::count_if(record.frames, &FrameRecord::is_warmup);
  const auto slow = std::max<std::ptrdiff_t>(warmup, slow_first_frames(times).value_or(0));
  times.erase(times.begin(), times.begin() + std::min<std::ptrdiff_t>(slow, std::ssize(times)));
  return times;
}

std::optional<int> slow_first_frames(const std::vector<double>& times) {
  if (times.size() < kFewestFrames) return std::nullopt;
  const std::vector<double> settled(times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2),
                                    times.end());
  const double middle = median(settled);
  const double limit =
      middle + std::max(kWarmupDeviations * scaled_mad(settled, middle), kWarmupFraction * middle);
  const auto first = std::ranges::find_if(times, [limit](double time) { return time <= limit; });
  const auto slow = static_cast<std::size_t>(first - times.begin());
  return slow > times.size() / 4 ? 0 : static_cast<int>(slow);
}

std::optional<double> relative_spread(const std::vector<double>& times) {
  if (times.empty()) return std::nullopt;
  return (*quantile(times, 0.75) - *quantile(times, 0.25)) / median(times);
}

std::optional<bool> is_noisy(const std::vector<double>& times) {
  if (times.size() < kFewestFrames) return std::nullopt;
  const double middle = median(times);
  const double limit = std::max(kOutlierDeviations * scaled_mad(times, middle), kNoisyFraction * middle);
  const auto outliers =
      std::ranges::count_if(times, [&](double time) { return std::abs(time - middle) > limit; });
  return *relative_spread(times) > kNoisyFraction ||
         static_cast<double>(outliers) > kNoisyOutliers * static_cast<double>(times.size());
}

std::string time_warnings(const std::vector<RunRecord>& records) {
  std::string text;
  for (const std::string& warning : {warmup_warning(records), noise_warning(records)}) {
    if (!warning.empty()) text += "- " + warning + '\n';
  }
  return text;
}

}  // namespace qtrace::experiments
