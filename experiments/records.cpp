#include "experiments/records.h"

#include "experiments/statistics.h"

namespace qtrace::experiments {
namespace {

CsvValue maybe(const std::optional<double>& value) { return value ? CsvValue(*value) : CsvValue(); }

CsvValue ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? CsvValue() : CsvValue(static_cast<double>(part) / static_cast<double>(whole));
}

// The errors of a row, or null where it has none.
const ErrorMetrics* errors_of(const SnapshotRecord& row) { return &row.errors; }
const ErrorMetrics* errors_of(const RunRecord& row) { return row.final_errors(); }

template <class Row, class Get>
Column<Row> error_column(const char* name, Get get) {
  return {name, [get](const Row& row) {
            const ErrorMetrics* errors = errors_of(row);
            return errors == nullptr ? CsvValue() : get(*errors);
          }};
}

template <class Row>
void add_error_columns(std::vector<Column<Row>>& columns) {
  using E = ErrorMetrics;
  columns.insert(
      columns.end(),
      {
          error_column<Row>("mse", [](const E& e) { return CsvValue(e.mse); }),
          error_column<Row>("relmse", [](const E& e) { return CsvValue(e.relmse); }),
          error_column<Row>("relmse_trimmed", [](const E& e) { return CsvValue(e.relmse_trimmed); }),
          error_column<Row>("mape", [](const E& e) { return CsvValue(e.mape); }),
          error_column<Row>("bias", [](const E& e) { return CsvValue(e.bias); }),
          error_column<Row>("reference_mse",
                            [](const E& e) { return e.reference ? CsvValue(e.reference->mse) : CsvValue(); }),
          error_column<Row>(
              "reference_relmse",
              [](const E& e) { return e.reference ? CsvValue(e.reference->relmse) : CsvValue(); }),
          error_column<Row>("at_reference_floor",
                            [](const E& e) { return CsvValue(e.at_reference_floor()); }),
          error_column<Row>("non_finite_pixels", [](const E& e) { return CsvValue(e.non_finite); }),
      });
}

// The counts that frames.csv has per frame and summary.csv as totals.
template <class Row, class Get>
void add_statistics_columns(std::vector<Column<Row>>& columns, Get get) {
  using S = FrameStatistics;
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

FrameStatistics RunRecord::totals() const {
  FrameStatistics total;
  for (const FrameRecord& frame : frames) {
    total.paths += frame.statistics.paths;
    total.rays += frame.statistics.rays;
    total.path_segments += frame.statistics.path_segments;
    total.zero_paths += frame.statistics.zero_paths;
    total.cell_lookups += frame.statistics.cell_lookups;
    total.cell_fallbacks += frame.statistics.cell_fallbacks;
    total.non_finite += frame.statistics.non_finite;
    total.table_updates += frame.statistics.table_updates;
    total.saturated_updates += frame.statistics.saturated_updates;
  }
  return total;
}

const ErrorMetrics* RunRecord::final_errors() const {
  return status == "finished" && !snapshots.empty() ? &snapshots.back().errors : nullptr;
}

std::optional<double> RunRecord::relmse_x_seconds() const {
  const ErrorMetrics* errors = final_errors();
  if (errors == nullptr) return std::nullopt;
  return errors->relmse * elapsed_s();
}

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
  add_statistics_columns(columns, [](const R& row) { return row.statistics; });
  return columns;
}

std::vector<Column<SnapshotRecord>> snapshot_columns() {
  using R = SnapshotRecord;
  std::vector<Column<R>> columns{
      {"frame", [](const R& row) { return CsvValue(std::int64_t{row.frame}); }},
      {"spp", [](const R& row) { return CsvValue(std::int64_t{row.frame}); }},
      {"elapsed_s", [](const R& row) { return CsvValue(row.elapsed_s); }},
      {"gpu_elapsed_s", [](const R& row) { return CsvValue(row.gpu_elapsed_s); }},
  };
  add_error_columns(columns);
  columns.push_back({"non_finite", [](const R& row) { return CsvValue(row.non_finite); }});
  return columns;
}

std::vector<Column<RunRecord>> run_columns(const std::vector<Axis>& axes) {
  using R = RunRecord;
  std::vector<Column<R>> columns{
      {"run", [](const R& row) { return CsvValue(row.run.id); }},
      {"cell", [](const R& row) { return CsvValue(row.run.cell); }},
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
          {"frames", [](const R& row) { return CsvValue(static_cast<std::uint64_t>(row.frames.size())); }},
      });
  add_time_columns(columns, "host", &R::host_ms);
  add_time_columns(columns, "gpu", &R::gpu_ms);
  columns.insert(columns.end(),
                 {
                     {"setup_s", [](const R& row) { return CsvValue(row.setup_s); }},
                     {"elapsed_s", [](const R& row) { return CsvValue(row.elapsed_s()); }},
                     {"gpu_elapsed_s", [](const R& row) { return CsvValue(row.gpu_elapsed_s()); }},
                 });
  add_error_columns(columns);
  columns.push_back({"relmse_x_s", [](const R& row) { return maybe(row.relmse_x_seconds()); }});
  add_statistics_columns(columns, [](const R& row) { return row.totals(); });
  columns.push_back({"reference_hash", [](const R& row) { return CsvValue(row.reference_hash); }});
  columns.push_back({"config_hash", [](const R& row) { return CsvValue(row.config_hash); }});
  return columns;
}

}  // namespace qtrace::experiments
