#include "experiments/records/records.h"

#include "experiments/records/curve.h"
#include "experiments/records/frame_times.h"
#include "experiments/measure/statistics.h"

#include <algorithm>

namespace qtrace::experiments {
namespace {

CsvValue ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? CsvValue() : CsvValue(static_cast<double>(part) / static_cast<double>(whole));
}

// The errors of a row, or null where it has none.
const ErrorMetrics* errors_of(const SnapshotRecord& row) { return &row.errors; }
const ErrorMetrics* errors_of(const RunRecord& row) { return row.final_errors(); }

// The filtered image of a row, or null where it has none.
const FilteredRecord* filtered(const SnapshotRecord& row) { return row.filtered ? &*row.filtered : nullptr; }
const FilteredRecord* filtered(const RunRecord& row) { return row.final_filtered(); }

const auto kPlain = [](const auto& row) { return errors_of(row); };
const auto kFiltered = [](const auto& row) {
  const FilteredRecord* record = filtered(row);
  return record == nullptr ? nullptr : &record->errors;
};

template <class Row, class Errors, class Get>
Column<Row> error_column(const std::string& name, Errors errors, Get get) {
  return {name, [errors, get](const Row& row) {
            const ErrorMetrics* found = errors(row);
            return found == nullptr ? CsvValue() : get(*found);
          }};
}

// `prefix`: biased errors never stand in a column with unbiased ones.
template <class Row, class Errors>
void add_error_columns(std::vector<Column<Row>>& columns, const std::string& prefix, Errors errors) {
  using E = ErrorMetrics;
  const auto column = [&](const char* name, auto get) {
    columns.push_back(error_column<Row>(prefix + name, errors, get));
  };
  column("mse", [](const E& e) { return CsvValue(e.mse); });
  column("relmse", [](const E& e) { return CsvValue(e.relmse); });
  column("relmse_trimmed", [](const E& e) { return CsvValue(e.relmse_trimmed); });
  column("mape", [](const E& e) { return CsvValue(e.mape); });
  column("smape", [](const E& e) { return CsvValue(e.smape); });
  column("psnr_db", [](const E& e) { return CsvValue(e.psnr_db); });
  column("flip", [](const E& e) { return maybe(e.flip); });
  column("bias", [](const E& e) { return CsvValue(e.bias); });
  column("mse_corrected", [](const E& e) { return maybe(e.mse_corrected()); });
  column("relmse_corrected", [](const E& e) { return maybe(e.relmse_corrected()); });
  column("at_reference_floor", [](const E& e) { return CsvValue(e.at_reference_floor()); });
  column("non_finite_pixels", [](const E& e) { return CsvValue(e.non_finite); });
}

template <class Row>
void add_reference_columns(std::vector<Column<Row>>& columns) {
  using E = ErrorMetrics;
  columns.push_back(error_column<Row>("reference_mse", kPlain, [](const E& e) {
    return e.reference ? CsvValue(e.reference->mse) : CsvValue();
  }));
  columns.push_back(error_column<Row>("reference_relmse", kPlain, [](const E& e) {
    return e.reference ? CsvValue(e.reference->relmse) : CsvValue();
  }));
}

// The filtered image, its errors and what it cost.
template <class Row>
void add_filter_columns(std::vector<Column<Row>>& columns) {
  add_error_columns(columns, "filtered_", kFiltered);
  columns.push_back({"filter_ms", [](const Row& row) {
                       const FilteredRecord* record = filtered(row);
                       return record == nullptr ? CsvValue() : CsvValue(record->filter_ms);
                     }});
}

// The counts that frames.csv has per frame and summary.csv as totals.
template <class Row, class Get>
void add_counter_columns(std::vector<Column<Row>>& columns, Get get) {
  using S = FrameCounters;
  const auto column = [get](const char* name, CsvValue (*value)(const S&)) {
    return Column<Row>{name, [get, value](const Row& row) { return value(get(row)); }};
  };
  columns.insert(columns.end(),
                 {
                     column("paths", [](const S& s) { return CsvValue(s.paths); }),
                     column("rays", [](const S& s) { return CsvValue(s.rays); }),
                     column("mean_path_length", [](const S& s) { return ratio(s.path_segments, s.paths); }),
                     column("zero_path_fraction", [](const S& s) { return ratio(s.zero_paths, s.paths); }),
                     column("cell_lookups", [](const S& s) { return CsvValue(s.cell_lookups); }),
                     column("cell_fallbacks", [](const S& s) { return CsvValue(s.cell_fallbacks); }),
                     column("table_updates", [](const S& s) { return CsvValue(s.table_updates); }),
                     column("saturated_updates", [](const S& s) { return CsvValue(s.saturated_updates); }),
                     column("non_finite", [](const S& s) { return CsvValue(s.non_finite); }),
                     column("fireflies", [](const S& s) { return CsvValue(s.fireflies); }),
                     column("clamped_samples", [](const S& s) { return CsvValue(s.clamped_samples); }),
                 });
}

// Median and spread of the frames that count: the clock's name in front.
void add_time_columns(std::vector<Column<RunRecord>>& columns, const std::string& clock,
                      std::vector<double> (RunRecord::*times)() const) {
  const auto at = [times](double q) {
    return [times, q](const RunRecord& row) { return maybe(quantile((row.*times)(), q)); };
  };
  const auto iqr = [times](const RunRecord& row) {
    const std::vector<double> values = (row.*times)();
    return values.empty() ? CsvValue() : CsvValue(*quantile(values, 0.75) - *quantile(values, 0.25));
  };
  columns.insert(columns.end(), {{clock + "_ms_median", at(0.5)},
                                 {clock + "_ms_p10", at(0.1)},
                                 {clock + "_ms_p90", at(0.9)},
                                 {clock + "_ms_iqr", iqr}});
}

// Snapshots of one run share samples, so its slope has no interval of its own: configurations.csv has one over seeds.
void add_slope_columns(std::vector<Column<RunRecord>>& columns) {
  const auto slope = [](Metric metric) {
    return [metric](const RunRecord& row) {
      return row.last_snapshot() == nullptr ? CsvValue() : maybe(loglog_slope(curve_of(row, metric)));
    };
  };
  columns.push_back({"slope_mse", slope(&ErrorMetrics::mse)});
  columns.push_back({"slope_relmse", slope(&ErrorMetrics::relmse)});
  columns.push_back({"snapshots_at_reference_floor", [](const RunRecord& row) {
                       return CsvValue(static_cast<std::uint64_t>(
                           std::ranges::count_if(row.snapshots, [](const SnapshotRecord& snapshot) {
                             return snapshot.errors.at_reference_floor();
                           })));
                     }});
}

// Of the machine, not of the sampler; empty for runs of few frames.
void add_quality_columns(std::vector<Column<RunRecord>>& columns) {
  columns.push_back({"warmup_detected", [](const RunRecord& row) {
                       const auto frames = slow_first_frames(times_per_ray(row));
                       return frames ? CsvValue(std::int64_t{*frames}) : CsvValue();
                     }});
  columns.push_back({"noisy", [](const RunRecord& row) {
                       const auto noisy = is_noisy(settled_times(row));
                       return noisy ? CsvValue(*noisy) : CsvValue();
                     }});
}

void add_outlier_columns(std::vector<Column<RunRecord>>& columns) {
  using R = RunRecord;
  columns.insert(
      columns.end(),
      {
          {"fireflies_per_million", [](const R& row) { return maybe(row.fireflies_per_million()); }},
          {"firefly_energy_fraction", [](const R& row) { return maybe(row.fireflies.energy_fraction); }},
          {"brightest_firefly", [](const R& row) { return maybe(row.fireflies.brightest); }},
          {"clamp_bias",
           [](const R& row) {
             const SnapshotRecord* last = row.last_snapshot();
             return last == nullptr ? CsvValue() : CsvValue(last->clamp_bias);
           }},
      });
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
  add_counter_columns(columns, [](const R& row) { return row.counters; });
  return columns;
}

std::vector<Column<SnapshotRecord>> snapshot_columns() {
  using R = SnapshotRecord;
  std::vector<Column<R>> columns = moment_columns();
  add_error_columns(columns, "", kPlain);
  add_reference_columns(columns);
  columns.push_back({"non_finite", [](const R& row) { return CsvValue(row.non_finite); }});
  columns.push_back({"clamped_samples", [](const R& row) { return CsvValue(row.clamped_samples); }});
  columns.push_back({"clamp_bias", [](const R& row) { return CsvValue(row.clamp_bias); }});
  return columns;
}

std::vector<Column<SnapshotRecord>> filtered_columns() {
  std::vector<Column<SnapshotRecord>> columns = moment_columns();
  add_filter_columns(columns);
  add_reference_columns(columns);
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
          {"status", [](const R& row) { return CsvValue(row.status); }},
          {"reason", [](const R& row) { return CsvValue(row.reason); }},
          {"order", [](const R& row) { return CsvValue(std::int64_t{row.order}); }},
          {"started", [](const R& row) { return CsvValue(row.started); }},
          {"frames", [](const R& row) { return CsvValue(static_cast<std::uint64_t>(row.frames.size())); }},
      });
  add_time_columns(columns, "host", &R::host_ms);
  add_time_columns(columns, "gpu", &R::gpu_ms);
  add_quality_columns(columns);
  columns.insert(columns.end(),
                 {
                     {"setup_s", [](const R& row) { return CsvValue(row.setup_s); }},
                     {"elapsed_s", [](const R& row) { return CsvValue(row.elapsed_s()); }},
                     {"gpu_elapsed_s", [](const R& row) { return CsvValue(row.gpu_elapsed_s()); }},
                 });
  add_error_columns(columns, "", kPlain);
  add_reference_columns(columns);
  columns.push_back({"relmse_x_s", [](const R& row) { return maybe(row.relmse_x_seconds()); }});
  add_slope_columns(columns);
  add_filter_columns(columns);
  add_counter_columns(columns, [](const R& row) { return row.totals(); });
  add_outlier_columns(columns);
  add_verdict_columns(columns);
  columns.push_back({"reference_hash", [](const R& row) { return CsvValue(row.reference_hash); }});
  columns.push_back({"config_hash", [](const R& row) { return CsvValue(row.config_hash); }});
  return columns;
}

}  // namespace qtrace::experiments
