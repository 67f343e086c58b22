// ratios.csv, and its table.
#include "experiments/records/ratios.h"
#include "experiments/files/text_table.h"

#include <fmt/format.h>

namespace qtrace::experiments {
namespace {

using Get = std::function<std::optional<Interval>(const Ratios&)>;

// The value and the ends of its interval.
void add_interval(std::vector<Column<Ratios>>& columns, const std::string& name, const Get& get) {
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

void add_time_to_error(std::vector<Column<Ratios>>& columns, const std::string& metric,
                       TimeToError Ratios::*times) {
  columns.push_back({"target_" + metric, [times](const Ratios& row) { return maybe((row.*times).target); }});
  add_interval(columns, "time_to_" + metric + "_s", [times](const Ratios& row) { return (row.*times).time; });
  add_interval(columns, "ratio_time_to_" + metric, [times](const Ratios& row) { return (row.*times).ratio; });
}

Get figure(const std::string& name) {
  return [name](const Ratios& row) {
    const auto found = row.figures.find(name);
    return found == row.figures.end() ? std::nullopt : std::optional(found->second);
  };
}

std::string text(const std::optional<Interval>& interval) {
  if (!interval) return "-";
  return interval->low
             ? fmt::format("{:.3g} [{:.3g}, {:.3g}]", interval->value, *interval->low, *interval->high)
             : fmt::format("{:.3g}", interval->value);
}

}  // namespace

std::vector<Column<Ratios>> ratio_columns() {
  std::vector<Column<Ratios>> columns{
      {"configuration", [](const Ratios& row) { return CsvValue(row.configuration); }},
      {"baseline", [](const Ratios& row) { return CsvValue(row.baseline); }},
      {"scene", [](const Ratios& row) { return CsvValue(row.scene); }},
  };
  for (const std::string& name : ratio_figures()) add_interval(columns, "ratio_" + name, figure(name));
  add_time_to_error(columns, "mse", &Ratios::mse);
  add_time_to_error(columns, "relmse", &Ratios::relmse);
  return columns;
}

std::string ratio_table(const std::vector<Ratios>& ratios, const std::string& scene) {
  std::vector<std::vector<std::string>> rows;
  for (const Ratios& row : ratios) {
    if (row.scene != scene) continue;
    rows.push_back({row.configuration, row.baseline, text(figure("host_ms_median")(row)), text(figure("mse")(row)),
                    text(figure("relmse")(row)), text(figure("relmse_trimmed")(row)),
                    text(figure("relmse_x_s")(row)), text(row.relmse.ratio)});
  }
  if (rows.empty()) return "";
  return "\nThe baseline's figure divided by the configuration's; above 1, the baseline needs more:\n\n" +
         markdown_table({"configuration", "baseline", "host ms/frame", "MSE", "relMSE", "relMSE trimmed", "relMSE × s",
                         "time to the baseline's relMSE"},
                        rows, 2);
}

}  // namespace qtrace::experiments
