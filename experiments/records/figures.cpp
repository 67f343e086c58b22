#include "experiments/records/figures.h"

#include "experiments/measure/statistics.h"
#include "experiments/records/curve.h"
#include "experiments/records/frame_times.h"

#include <fmt/format.h>

#include <algorithm>

namespace qtrace::experiments {
namespace {

using R = RunRecord;
using Figures = std::vector<Figure>;

constexpr const char* kProject = "this project";

CsvValue ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? CsvValue() : CsvValue(static_cast<double>(part) / static_cast<double>(whole));
}

// Median and spread of the frames that count: the clock's name in front.
void add_times(Figures& figures, const std::string& clock, const std::string& label,
               std::vector<double> (R::*times)() const) {
  const auto at = [times](double q) {
    return [times, q](const R& row) { return maybe(quantile((row.*times)(), q)); };
  };
  const auto iqr = [times](const R& row) {
    const std::vector<double> values = (row.*times)();
    return values.empty() ? CsvValue() : CsvValue(*quantile(values, 0.75) - *quantile(values, 0.25));
  };
  const std::string of = fmt::format(" of {}_ms over the frames after warm-up", clock);
  figures.push_back({.column = {clock + "_ms_median", at(0.5)},
                     .label = label + " ms/frame",
                     .unit = "ms",
                     .formula = "median" + of,
                     .is_averaged = true,
                     .is_compared = true});
  figures.push_back({.column = {clock + "_ms_p10", at(0.1)},
                     .label = label + " ms/frame, 10 %",
                     .unit = "ms",
                     .formula = "10th percentile" + of});
  figures.push_back({.column = {clock + "_ms_p90", at(0.9)},
                     .label = label + " ms/frame, 90 %",
                     .unit = "ms",
                     .formula = "90th percentile" + of});
  figures.push_back({.column = {clock + "_ms_iqr", iqr},
                     .label = label + " ms/frame, quartiles",
                     .unit = "ms",
                     .formula = "interquartile range" + of});
}

// Of the machine, not of the sampler; empty for runs of few frames.
void add_quality(Figures& figures) {
  figures.push_back({.column = {"warmup_detected",
                                [](const R& row) {
                                  const auto frames = slow_first_frames(times_per_ray(row));
                                  return frames ? CsvValue(std::int64_t{*frames}) : CsvValue();
                                }},
                     .label = "slow first frames",
                     .unit = "frames",
                     .formula = "frames at the start that are slower than the rest, per ray",
                     .source = kProject});
  figures.push_back(
      {.column = {"noisy",
                  [](const R& row) {
                    const auto noisy = is_noisy(settled_times(row));
                    return noisy ? CsvValue(*noisy) : CsvValue();
                  }},
       .label = "noisy",
       .unit = "",
       .formula = fmt::format("whether the times per ray spread by more than {:g} of their median, "
                              "or more than {:g} of them are outliers",
                              kNoisyFraction, kNoisyOutliers),
       .source = kProject});
}

void add_totals(Figures& figures) {
  figures.push_back({.column = {"setup_s", [](const R& row) { return CsvValue(row.setup_s); }},
                     .label = "setup",
                     .unit = "s",
                     .formula = "hierarchy, cells and shaders, before the first frame; not in elapsed_s",
                     .is_averaged = true});
  figures.push_back({.column = {"elapsed_s", [](const R& row) { return CsvValue(row.elapsed_s()); }},
                     .label = "s",
                     .unit = "s",
                     .formula = "sum of host_ms over all frames",
                     .is_averaged = true});
  figures.push_back({.column = {"gpu_elapsed_s", [](const R& row) { return CsvValue(row.gpu_elapsed_s()); }},
                     .label = "GPU s",
                     .unit = "s",
                     .formula = "sum of gpu_ms over all frames",
                     .is_averaged = true});
}

void add_errors(Figures& figures) {
  for (const Metric& metric : error_metrics()) {
    const auto get = [&metric](const R& row) {
      const ErrorMetrics* errors = row.final_errors();
      return errors == nullptr ? CsvValue() : metric.value(*errors);
    };
    figures.push_back({.column = {metric.name, get},
                       .label = metric.label,
                       .unit = metric.unit,
                       .formula = metric.formula,
                       .source = metric.source,
                       .is_signed = metric.is_signed,
                       .is_averaged = metric.is_averaged,
                       .is_compared = metric.is_compared,
                       .is_error = metric.is_of_image && metric.is_averaged});
  }
  figures.push_back({.column = {"relmse_x_s", [](const R& row) { return maybe(row.relmse_x_seconds()); }},
                     .label = "relMSE × s",
                     .unit = "s",
                     .formula = "relmse * elapsed_s, at the last frame",
                     .source = kProject,
                     .is_averaged = true,
                     .is_compared = true});
}

// Snapshots of one run share samples, so its slope has no interval of its own: configurations.csv has one
// over seeds.
void add_slopes(Figures& figures) {
  for (const Metric& metric : error_metrics()) {
    if (!metric.is_followed) continue;
    const auto get = [&metric](const R& row) {
      return row.last_snapshot() == nullptr ? CsvValue() : maybe(loglog_slope(curve_of(row, metric)));
    };
    figures.push_back({.column = {"slope_" + metric.name, get},
                       .label = "slope of " + metric.label,
                       .unit = "",
                       .formula = fmt::format("b of {} = a spp^b, least squares on logarithms above the "
                                              "reference's floor",
                                              metric.name),
                       .source = kProject,
                       .is_signed = true,
                       .is_averaged = true});
  }
  const auto at_floor = [](const R& row) {
    return CsvValue(static_cast<std::uint64_t>(std::ranges::count_if(
        row.snapshots, [](const SnapshotRecord& snapshot) { return snapshot.errors.at_reference_floor(); })));
  };
  figures.push_back({.column = {"snapshots_at_reference_floor", at_floor},
                     .label = "snapshots at floor",
                     .unit = "snapshots",
                     .formula = "snapshots whose error is at_reference_floor",
                     .source = kProject});
}

// The filtered image: biased errors never stand in a column with unbiased ones.
void add_filtered(Figures& figures) {
  for (const Metric& metric : error_metrics()) {
    if (!metric.is_of_image) continue;
    const auto get = [&metric](const R& row) {
      const FilteredRecord* filtered = row.final_filtered();
      return filtered == nullptr ? CsvValue() : metric.value(filtered->errors);
    };
    figures.push_back({.column = {"filtered_" + metric.name, get},
                       .label = metric.label + " filtered (biased)",
                       .unit = metric.unit,
                       .formula = metric.name + " of the image after the filter, which is biased",
                       .source =
                           "Dammertz, Sewtz, Hanika, Lensch 2010, Edge-avoiding a-trous wavelet transform "
                           "for fast global illumination filtering",
                       .is_signed = metric.is_signed,
                       .is_averaged = metric.is_compared});
  }
  const auto milliseconds = [](const R& row) {
    const FilteredRecord* filtered = row.final_filtered();
    return filtered == nullptr ? CsvValue() : CsvValue(filtered->filter_ms);
  };
  figures.push_back({.column = {"filter_ms", milliseconds},
                     .label = "filter ms",
                     .unit = "ms",
                     .formula = "host clock: upload, passes and readback; in no other time",
                     .is_averaged = true});
}

void add_outliers(Figures& figures) {
  figures.push_back(
      {.column = {"fireflies_per_million", [](const R& row) { return maybe(row.fireflies_per_million()); }},
       .label = "fireflies / M samples",
       .unit = "",
       .formula = fmt::format("samples whose mean over channels exceeds firefly_multiple * max(mean "
                              "over channels of r, {} of the same averaged over all pixels), before "
                              "clamping, in a million",
                              kFireflyFloor),
       .source = kProject,
       .is_averaged = true});
  figures.push_back({.column = {"firefly_energy_fraction",
                                [](const R& row) { return maybe(row.fireflies.energy_fraction); }},
                     .label = "share of fireflies",
                     .unit = "",
                     .formula = "radiance of all fireflies / radiance of all samples, before clamping",
                     .source = kProject});
  figures.push_back(
      {.column = {"brightest_firefly", [](const R& row) { return maybe(row.fireflies.brightest); }},
       .label = "brightest firefly",
       .unit = "radiance",
       .formula = "its mean over channels, before clamping",
       .source = kProject});
  figures.push_back({.column = {"clamp_bias",
                                [](const R& row) {
                                  const SnapshotRecord* last = row.last_snapshot();
                                  return last == nullptr ? CsvValue() : CsvValue(last->clamp_bias);
                                }},
                     .label = "bias of clamping",
                     .unit = "radiance",
                     .formula = "mean over pixels and channels of the image minus what it would be without "
                                "clamp_radiance",
                     .source = kProject,
                     .is_signed = true,
                     .is_averaged = true});
}

}  // namespace

std::vector<CounterColumn> counter_columns() {
  using C = FrameCounters;
  return {
      {"paths", "paths", "", [](const C& c) { return CsvValue(c.paths); }},
      {"rays", "rays", "", [](const C& c) { return CsvValue(c.rays); }},
      {"mean_path_length", "mean path length", "segments",
       [](const C& c) { return ratio(c.path_segments, c.paths); }, true},
      {"zero_path_fraction", "share of zero paths", "",
       [](const C& c) { return ratio(c.zero_paths, c.paths); }, true},
      {"cell_lookups", "cell look-ups", "", [](const C& c) { return CsvValue(c.cell_lookups); }},
      {"cell_fallbacks", "cell fallbacks", "", [](const C& c) { return CsvValue(c.cell_fallbacks); }},
      {"table_updates", "table updates", "", [](const C& c) { return CsvValue(c.table_updates); }},
      {"saturated_updates", "saturated updates", "",
       [](const C& c) { return CsvValue(c.saturated_updates); }},
      {"non_finite", "non-finite", "samples", [](const C& c) { return CsvValue(c.non_finite); }},
      {"fireflies", "fireflies", "samples", [](const C& c) { return CsvValue(c.fireflies); }},
      {"clamped_samples", "clamped samples", "samples",
       [](const C& c) { return CsvValue(c.clamped_samples); }},
      {"light_rays", "rays of light paths", "", [](const C& c) { return CsvValue(c.light_rays); }},
      {"splats", "splats", "", [](const C& c) { return CsvValue(c.splats); }},
      {"connections", "connections", "", [](const C& c) { return CsvValue(c.connections); }},
  };
}

const std::vector<Figure>& run_figures() {
  static const Figures all = [] {
    Figures figures;
    add_times(figures, "host", "host", &R::host_ms);
    add_times(figures, "gpu", "GPU", &R::gpu_ms);
    add_quality(figures);
    add_totals(figures);
    add_errors(figures);
    add_slopes(figures);
    add_filtered(figures);
    for (const CounterColumn& counter : counter_columns()) {
      const auto get = [value = counter.value](const R& row) { return value(row.totals()); };
      figures.push_back({.column = {counter.name, get},
                         .label = counter.label,
                         .unit = counter.unit,
                         .formula = "over all frames",
                         .is_averaged = counter.is_averaged});
    }
    add_outliers(figures);
    return figures;
  }();
  return all;
}

Json figures_json() {
  Json all = Json::array();
  for (const Figure& figure : run_figures()) {
    all.push_back({{"name", figure.column.name},
                   {"label", figure.label},
                   {"unit", figure.unit},
                   {"signed", figure.is_signed},
                   {"per_configuration", figure.is_averaged},
                   {"error", figure.is_error},
                   {"formula", figure.formula},
                   {"source", figure.source}});
  }
  return all;
}

}  // namespace qtrace::experiments
