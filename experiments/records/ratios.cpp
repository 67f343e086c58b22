#include "experiments/records/ratios.h"

#include <algorithm>
#include <cmath>

namespace qtrace::experiments {
namespace {

// The variance of one side of a comparison, and the seeds behind it.
struct Side {
  double variance = 0;
  std::size_t seeds = 0;
};

// Welch 1947, The generalization of 'Student's' problem when several different population variances are
// involved.
Interval welch(double log_value, const Side& a, const Side& b) {
  Interval result{std::exp(log_value), {}, {}};
  const double variance = a.variance + b.variance;
  double inverse_degrees = 0;
  for (const Side& side : {a, b}) {
    if (side.seeds == 0) continue;       // known exactly
    if (side.seeds == 1) return result;  // its variance is unknown
    if (variance == 0 || side.variance == 0) continue;
    const double share = side.variance / variance;
    inverse_degrees += share * share / static_cast<double>(side.seeds - 1);
  }
  const double half_width = variance == 0 ? 0 : t_quantile(1 / inverse_degrees) * std::sqrt(variance);
  result.low = result.value * std::exp(-half_width);
  result.high = result.value * std::exp(half_width);
  return result;
}

Side relative_error(const Estimate& estimate) {
  const double relative = estimate.sd.value_or(0) / estimate.mean;
  return {relative * relative / static_cast<double>(estimate.count), estimate.count};
}

// Efron and Stein 1981, The jackknife estimate of variance.
Side jackknife_variance(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double mean = 0;
  for (const double value : values) mean += value / count;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {values.empty() ? 0 : squares * (count - 1) / count, values.size()};
}

// log(the baseline's seconds / the configuration's until it has the baseline's error), both mean curves.
std::optional<double> log_time_ratio(const Curve& baseline, const Curve& configuration) {
  const auto time = time_to_error(configuration, baseline.back().error);
  return time ? std::optional(std::log(baseline.back().seconds / *time)) : std::nullopt;
}

// The curves of a configuration, one for each seed.
struct SeedCurves {
  std::vector<std::uint32_t> seeds;
  std::vector<Curve> curves;
};

SeedCurves curves_of(const Configuration& configuration, const Metric& metric) {
  SeedCurves result;
  for (const RunRecord* run : configuration.members) {
    result.seeds.push_back(run->run.config.render.seed);
    result.curves.push_back(curve_of(*run, metric));
  }
  return result;
}

// `without(i)` for each seed; nothing where one of them is nothing or there is one seed alone.
template <class Without>
std::optional<std::vector<double>> leave_one_out(std::size_t seeds, Without without) {
  std::vector<double> values;
  for (std::size_t i = 0; i < seeds && seeds > 1; ++i) {
    const std::optional<double> value = without(i);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values.empty() ? std::nullopt : std::optional(values);
}

// log(the baseline's error / the configuration's) after the seconds of whichever ends first, both mean
// curves.
std::optional<double> log_error_ratio(const Curve& baseline, const Curve& configuration) {
  if (baseline.empty() || configuration.empty()) return std::nullopt;
  const double seconds = std::min(baseline.back().seconds, configuration.back().seconds);
  const auto above = error_after(baseline, seconds);
  const auto below = error_after(configuration, seconds);
  return above && below ? std::optional(std::log(*above / *below)) : std::nullopt;
}

using LogRatio = std::optional<double> (*)(const Curve&, const Curve&);

// The interval of a ratio of mean curves, `value` its logarithm, by leaving out the same seed of both.
std::optional<Interval> paired_interval(double value, const std::vector<Curve>& baseline,
                                        const std::vector<Curve>& configuration, LogRatio log_ratio) {
  const auto both = leave_one_out(baseline.size(), [&](std::size_t i) {
    return log_ratio(mean_curve(baseline, i), mean_curve(configuration, i));
  });
  return both ? std::optional(jackknife(value, *both, {})) : std::nullopt;
}

// The same by leaving out the seeds of each side apart.
std::optional<Interval> unpaired_interval(double value, const std::vector<Curve>& baseline,
                                          const std::vector<Curve>& configuration, LogRatio log_ratio) {
  const Curve baseline_mean = mean_curve(baseline);
  const Curve configuration_mean = mean_curve(configuration);
  const auto above = leave_one_out(
      baseline.size(), [&](std::size_t i) { return log_ratio(mean_curve(baseline, i), configuration_mean); });
  const auto below = leave_one_out(configuration.size(), [&](std::size_t i) {
    return log_ratio(baseline_mean, mean_curve(configuration, i));
  });
  return above && below ? std::optional(jackknife(value, *above, *below)) : std::nullopt;
}

// Of two mean curves, whose logarithm of a ratio `log_ratio` gives.
std::optional<Interval> curve_ratio(const SeedCurves& baseline, const SeedCurves& configuration,
                                    LogRatio log_ratio) {
  const auto value = log_ratio(mean_curve(baseline.curves), mean_curve(configuration.curves));
  if (!value) return std::nullopt;
  const bool is_paired = baseline.seeds.size() >= kFewestPairedSeeds && baseline.seeds == configuration.seeds;
  const auto interval = (is_paired ? paired_interval : unpaired_interval)(*value, baseline.curves,
                                                                          configuration.curves, log_ratio);
  return interval ? interval : Interval{std::exp(*value), {}, {}};
}

TimeToError compare_times(const Configuration& baseline, const Configuration& configuration,
                          const Metric& metric) {
  const SeedCurves baseline_curves = curves_of(baseline, metric);
  const SeedCurves configuration_curves = curves_of(configuration, metric);
  TimeToError result;
  if (baseline_curves.curves.empty() || configuration_curves.curves.empty()) return result;
  result.target = mean_curve(baseline_curves.curves).back().error;
  result.time = time_to_error(configuration_curves.curves, *result.target);
  result.ratio = curve_ratio(baseline_curves, configuration_curves, log_time_ratio);
  return result;
}

// The baseline that differs from the configuration in one label alone, or null.
const Configuration* baseline_of(const Experiment& experiment, const Configuration& configuration,
                                 const std::vector<Configuration>& configurations) {
  for (std::size_t axis = 0; axis < experiment.axes.size(); ++axis) {
    if (experiment.axes[axis].is_seed) continue;
    for (const Configuration& other : configurations) {
      if (&other == &configuration) continue;
      std::vector<std::string> labels = configuration.labels;
      labels[axis] = other.labels[axis];
      const bool is_named = other.labels[axis] == experiment.baseline || other.name == experiment.baseline;
      if (is_named && labels == other.labels && other.scene == configuration.scene) return &other;
    }
  }
  return nullptr;
}

}  // namespace

std::optional<Interval> Ratios::figure(const std::string& column) const {
  const auto found = figures.find(column);
  return found == figures.end() ? std::nullopt : std::optional(found->second);
}

std::optional<Interval> ratio_of_means(const Estimate& above, const Estimate& below) {
  if (!(above.mean > 0) || !(below.mean > 0)) return std::nullopt;
  return welch(std::log(above.mean / below.mean), relative_error(above), relative_error(below));
}

Interval jackknife(double log_value, const std::vector<double>& log_above,
                   const std::vector<double>& log_below) {
  return welch(log_value, jackknife_variance(log_above), jackknife_variance(log_below));
}

std::optional<Interval> time_to_error(const std::vector<Curve>& seeds, double target) {
  const auto time = time_to_error(mean_curve(seeds), target);
  if (!time) return std::nullopt;
  const auto others = leave_one_out(seeds.size(), [&](std::size_t i) -> std::optional<double> {
    const auto without = time_to_error(mean_curve(seeds, i), target);
    return without ? std::optional(std::log(*without)) : std::nullopt;
  });
  return others ? jackknife(std::log(*time), *others, {}) : Interval{*time, {}, {}};
}

std::vector<Ratios> baseline_ratios(const Experiment& experiment,
                                    const std::vector<Configuration>& configurations) {
  std::vector<Ratios> rows;
  if (experiment.baseline.empty()) return rows;
  for (const Configuration& configuration : configurations) {
    const Configuration* baseline = baseline_of(experiment, configuration, configurations);
    if (baseline == nullptr) continue;
    Ratios row{configuration.name, baseline->name, configuration.scene, {}, {}, {}};
    for (const Figure& figure : run_figures()) {
      const auto above = baseline->figure(figure.column.name);
      const auto below = configuration.figure(figure.column.name);
      if (!figure.is_compared || !above || !below) continue;
      if (const auto ratio = ratio_of_means(*above, *below)) row.figures[figure.column.name] = *ratio;
    }
    for (const Metric& metric : error_metrics()) {
      if (metric.is_followed) row.times[metric.name] = compare_times(*baseline, configuration, metric);
      if (metric.is_timed)
        row.equal_seconds[metric.name] =
            curve_ratio(curves_of(*baseline, metric), curves_of(configuration, metric), log_error_ratio);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace qtrace::experiments
