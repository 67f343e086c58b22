// The columns of configurations.csv.
#include "experiments/records/configurations.h"

namespace qtrace::experiments {
namespace {

void add_figure_columns(std::vector<Column<Configuration>>& columns, const std::string& figure) {
  const auto column = [&](const std::string& suffix, CsvValue (*get)(const Estimate&)) {
    columns.push_back({figure + suffix, [figure, get](const Configuration& configuration) {
                         const auto found = configuration.figures.find(figure);
                         return found == configuration.figures.end() ? CsvValue() : get(found->second);
                       }});
  };
  column("", [](const Estimate& e) { return CsvValue(e.mean); });
  column("_sd", [](const Estimate& e) { return maybe(e.sd); });
  column("_low", [](const Estimate& e) { return maybe(e.low); });
  column("_high", [](const Estimate& e) { return maybe(e.high); });
}

template <class Get>
void add_part(std::vector<Column<Configuration>>& columns, const std::string& name, Get get) {
  columns.push_back({name, [get](const Configuration& configuration) { return configuration.parts ? get(*configuration.parts) : CsvValue(); }});
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

}  // namespace

const std::vector<ConfigurationFigure>& configuration_figures() {
  static const std::vector<ConfigurationFigure> figures{
      {"host_ms_median"},
      {"gpu_ms_median"},
      {"setup_s"},
      {"elapsed_s"},
      {"gpu_elapsed_s"},
      {"mse"},
      {"relmse"},
      {"relmse_trimmed"},
      {"mse_corrected", true},
      {"relmse_corrected", true},
      {"mape"},
      {"smape"},
      {"psnr_db", true},
      {"flip"},
      {"bias", true},
      {"relmse_x_s"},
      {"slope_mse", true},
      {"slope_relmse", true},
      {"filtered_relmse"},
      {"filter_ms"},
      {"mean_path_length"},
      {"zero_path_fraction"},
      {"clamp_bias", true},
      {"fireflies_per_million"},
  };
  return figures;
}

std::vector<Column<Configuration>> configuration_columns(const std::vector<Axis>& axes) {
  std::vector<Column<Configuration>> columns{{"configuration", [](const Configuration& configuration) { return CsvValue(configuration.name); }}};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].is_seed) continue;
    columns.push_back({"axis:" + axes[i].name, [i](const Configuration& configuration) { return CsvValue(configuration.labels[i]); }});
  }
  columns.insert(columns.end(),
                 {{"scene", [](const Configuration& configuration) { return CsvValue(configuration.scene); }},
                  {"frames", [](const Configuration& configuration) { return CsvValue(std::int64_t{configuration.frames}); }},
                  {"runs", [](const Configuration& configuration) { return CsvValue(std::uint64_t{configuration.runs}); }},
                  {"seeds", [](const Configuration& configuration) { return CsvValue(std::uint64_t{configuration.finished}); }},
                  {"seeds_at_reference_floor",
                   [](const Configuration& configuration) { return CsvValue(std::uint64_t{configuration.at_reference_floor}); }}});
  for (const ConfigurationFigure& figure : configuration_figures()) add_figure_columns(columns, figure.column);
  add_part_columns(columns);
  return columns;
}

}  // namespace qtrace::experiments
