#include "experiments/records/columns.h"

#include "experiments/records/figures.h"

#include <functional>

namespace qtrace::experiments {
namespace {

// The moment that a row of convergence.csv and convergence_filtered.csv is about.
std::vector<Column<SnapshotRecord>> moment_columns() {
  using R = SnapshotRecord;
  return {
      {"frame", [](const R& row) { return CsvValue(std::int64_t{row.frame}); }},
      {"spp", [](const R& row) { return CsvValue(std::int64_t{row.frame}); }},
      {"elapsed_s", [](const R& row) { return CsvValue(row.elapsed_s); }},
      {"gpu_elapsed_s", [](const R& row) { return CsvValue(row.gpu_elapsed_s); }},
  };
}

void add_error_columns(std::vector<Column<SnapshotRecord>>& columns, bool of_image) {
  for (const Metric& metric : error_metrics()) {
    if (metric.is_of_image != of_image) continue;
    columns.push_back(
        {metric.name, [&metric](const SnapshotRecord& row) { return metric.value(row.errors); }});
  }
}

void add_verdict_columns(std::vector<Column<RunRecord>>& columns) {
  const auto column = [&](const char* name, CsvValue (*value)(const Verdict&)) {
    columns.push_back(
        {name, [value](const RunRecord& row) { return row.verdict ? value(*row.verdict) : CsvValue(); }});
  };
  column("verdict", [](const Verdict& v) { return CsvValue(v.word); });
  column("verdict_reason", [](const Verdict& v) { return CsvValue(v.reason); });
  column("mean", [](const Verdict& v) { return CsvValue(v.mean); });
  column("mean_error", [](const Verdict& v) { return CsvValue(v.mean_error); });
  column("expected_mean", [](const Verdict& v) { return CsvValue(v.expected); });
  column("worst_z", [](const Verdict& v) { return CsvValue(v.worst_z); });
}

void add_figure_columns(std::vector<Column<Configuration>>& columns, const std::string& figure) {
  const auto column = [&](const std::string& suffix, CsvValue (*get)(const Estimate&)) {
    columns.push_back({figure + suffix, [figure, get](const Configuration& configuration) {
                         const auto found = configuration.figure(figure);
                         return found ? get(*found) : CsvValue();
                       }});
  };
  column("", [](const Estimate& e) { return CsvValue(e.mean); });
  column("_sd", [](const Estimate& e) { return maybe(e.sd); });
  column("_low", [](const Estimate& e) { return maybe(e.low); });
  column("_high", [](const Estimate& e) { return maybe(e.high); });
}

template <class Get>
void add_part(std::vector<Column<Configuration>>& columns, const std::string& name, Get get) {
  columns.push_back({name, [get](const Configuration& configuration) {
                       return configuration.parts ? get(*configuration.parts) : CsvValue();
                     }});
}

void add_part_columns(std::vector<Column<Configuration>>& columns) {
  using P = ErrorParts;
  add_part(columns, "variance", [](const P& p) { return CsvValue(p.variance); });
  add_part(columns, "bias2", [](const P& p) { return CsvValue(p.bias2.mean); });
  add_part(columns, "bias2_low", [](const P& p) { return maybe(p.bias2.low); });
  add_part(columns, "bias2_high", [](const P& p) { return maybe(p.bias2.high); });
  add_part(columns, "abs_bias", [](const P& p) { return CsvValue(p.abs_bias()); });
  add_part(columns, "abs_bias_low", [](const P& p) { return maybe(p.abs_bias_low()); });
  add_part(columns, "abs_bias_high", [](const P& p) { return maybe(p.abs_bias_high()); });
}

using GetInterval = std::function<std::optional<Interval>(const Ratios&)>;

// The value and the ends of its interval.
void add_interval(std::vector<Column<Ratios>>& columns, const std::string& name, const GetInterval& get) {
  const auto column = [&](const std::string& suffix, CsvValue (*value)(const Interval&)) {
    columns.push_back({name + suffix, [get, value](const Ratios& row) {
                         const auto interval = get(row);
                         return interval ? value(*interval) : CsvValue();
                       }});
  };
  column("", [](const Interval& i) { return CsvValue(i.value); });
  column("_low", [](const Interval& i) { return maybe(i.low); });
  column("_high", [](const Interval& i) { return maybe(i.high); });
}

void add_time_to_error(std::vector<Column<Ratios>>& columns, const std::string& metric) {
  columns.push_back(
      {"target_" + metric, [metric](const Ratios& row) { return maybe(row.times.at(metric).target); }});
  add_interval(columns, "time_to_" + metric + "_s",
               [metric](const Ratios& row) { return row.times.at(metric).time; });
  add_interval(columns, "ratio_time_to_" + metric,
               [metric](const Ratios& row) { return row.times.at(metric).ratio; });
}

}  // namespace

std::vector<Column<FrameRecord>> frame_columns() {
  using R = FrameRecord;
  std::vector<Column<R>> columns{
      {"frame", [](const R& row) { return CsvValue(std::int64_t{row.frame}); }},
      {"is_warmup", [](const R& row) { return CsvValue(row.is_warmup); }},
      {"host_ms", [](const R& row) { return CsvValue(row.host_ms); }},
      {"gpu_ms", [](const R& row) { return CsvValue(row.gpu_ms); }},
      {"elapsed_s", [](const R& row) { return CsvValue(row.elapsed_s); }},
      {"gpu_elapsed_s", [](const R& row) { return CsvValue(row.gpu_elapsed_s); }},
  };
  for (const CounterColumn& counter : counter_columns()) {
    columns.push_back({counter.name, [value = counter.value](const R& row) { return value(row.counters); }});
  }
  return columns;
}

std::vector<Column<SnapshotRecord>> snapshot_columns() {
  using R = SnapshotRecord;
  std::vector<Column<R>> columns = moment_columns();
  add_error_columns(columns, true);
  add_error_columns(columns, false);
  columns.push_back({"non_finite", [](const R& row) { return CsvValue(row.non_finite); }});
  columns.push_back({"clamped_samples", [](const R& row) { return CsvValue(row.clamped_samples); }});
  columns.push_back({"clamp_bias", [](const R& row) { return CsvValue(row.clamp_bias); }});
  return columns;
}

std::vector<Column<SnapshotRecord>> filtered_columns() {
  using R = SnapshotRecord;
  std::vector<Column<R>> columns = moment_columns();
  for (const Metric& metric : error_metrics()) {
    if (!metric.is_of_image) continue;
    columns.push_back({"filtered_" + metric.name, [&metric](const R& row) {
                         return row.filtered ? metric.value(row.filtered->errors) : CsvValue();
                       }});
  }
  columns.push_back({"filter_ms", [](const R& row) {
                       return row.filtered ? CsvValue(row.filtered->filter_ms) : CsvValue();
                     }});
  add_error_columns(columns, false);
  return columns;
}

std::vector<Column<RunRecord>> run_columns(const std::vector<Axis>& axes) {
  using R = RunRecord;
  std::vector<Column<R>> columns{
      {"run", [](const R& row) { return CsvValue(row.run.id); }},
      {"configuration", [](const R& row) { return CsvValue(row.run.configuration); }},
  };
  for (std::size_t i = 0; i < axes.size(); ++i) {
    columns.push_back({"axis:" + axes[i].name, [i](const R& row) { return CsvValue(row.run.labels[i]); }});
  }
  columns.insert(
      columns.end(),
      {
          {"scene", [](const R& row) { return CsvValue(row.scene); }},
          {"seed", [](const R& row) { return CsvValue(std::uint64_t{row.run.config.render.seed}); }},
          {"status", [](const R& row) { return CsvValue(std::string(enum_name(row.status))); }},
          {"reason", [](const R& row) { return CsvValue(row.reason); }},
          {"order", [](const R& row) { return CsvValue(std::int64_t{row.order}); }},
          {"started", [](const R& row) { return CsvValue(row.started); }},
          {"frames", [](const R& row) { return CsvValue(static_cast<std::uint64_t>(row.frames.size())); }},
      });
  for (const Figure& figure : run_figures()) columns.push_back(figure.column);
  columns.push_back({"table_given_up_after", [](const R& row) {
                       return row.table_given_up ? CsvValue(std::uint64_t{*row.table_given_up}) : CsvValue();
                     }});
  columns.push_back({"light_paths_given_up", [](const R& row) {
                       return CsvValue(std::uint64_t{row.light_paths_given_up ? 1U : 0U});
                     }});
  add_verdict_columns(columns);
  columns.push_back({"reference_hash", [](const R& row) { return CsvValue(row.reference_hash); }});
  columns.push_back({"config_hash", [](const R& row) { return CsvValue(row.config_hash); }});
  return columns;
}

std::vector<Column<Configuration>> configuration_columns(const std::vector<Axis>& axes) {
  std::vector<Column<Configuration>> columns{
      {"configuration", [](const Configuration& configuration) { return CsvValue(configuration.name); }}};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].is_seed) continue;
    columns.push_back({"axis:" + axes[i].name, [i](const Configuration& configuration) {
                         return CsvValue(configuration.labels[i]);
                       }});
  }
  columns.insert(
      columns.end(),
      {{"scene", [](const Configuration& configuration) { return CsvValue(configuration.scene); }},
       {"frames",
        [](const Configuration& configuration) { return CsvValue(std::int64_t{configuration.frames}); }},
       {"runs",
        [](const Configuration& configuration) { return CsvValue(std::uint64_t{configuration.runs}); }},
       {"seeds",
        [](const Configuration& configuration) { return CsvValue(std::uint64_t{configuration.finished}); }},
       {"seeds_at_reference_floor", [](const Configuration& configuration) {
          return CsvValue(std::uint64_t{configuration.at_reference_floor});
        }}});
  for (const Figure& figure : run_figures()) {
    if (figure.is_averaged) add_figure_columns(columns, figure.column.name);
  }
  add_part_columns(columns);
  return columns;
}

std::vector<Column<Ratios>> ratio_columns() {
  std::vector<Column<Ratios>> columns{
      {"configuration", [](const Ratios& row) { return CsvValue(row.configuration); }},
      {"baseline", [](const Ratios& row) { return CsvValue(row.baseline); }},
      {"scene", [](const Ratios& row) { return CsvValue(row.scene); }},
  };
  for (const Figure& figure : run_figures()) {
    if (figure.is_compared)
      add_interval(columns, "ratio_" + figure.column.name,
                   [name = figure.column.name](const Ratios& row) { return row.figure(name); });
  }
  for (const Metric& metric : error_metrics()) {
    if (metric.is_followed) add_time_to_error(columns, metric.name);
    if (metric.is_timed)
      add_interval(columns, "ratio_equal_s_" + metric.name,
                   [name = metric.name](const Ratios& row) { return row.equal_seconds.at(name); });
  }
  return columns;
}

}  // namespace qtrace::experiments
