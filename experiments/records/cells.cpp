#include "experiments/records/cells.h"

#include "engine/core/check.h"

#include <algorithm>

namespace qtrace::experiments {
namespace {

using Members = std::vector<const RunRecord*>;

std::optional<FrameTimes> pooled_times(const Members& runs, std::vector<double> (RunRecord::*times)() const) {
  std::vector<double> pooled;
  for (const RunRecord* run : runs) {
    for (const double time : (run->*times)()) pooled.push_back(time);
  }
  if (pooled.empty()) return std::nullopt;
  return FrameTimes{*quantile(pooled, 0.5), *quantile(pooled, 0.1), *quantile(pooled, 0.9)};
}

std::map<std::string, Estimate> estimate_figures(const Members& runs) {
  std::map<std::string, Estimate> figures;
  const std::vector<Column<RunRecord>> columns = run_columns({});
  for (const CellFigure& figure : cell_figures()) {
    const auto column = std::ranges::find(columns, figure.column, &Column<RunRecord>::name);
    check(column != columns.end(), "summary.csv has no column '{}'", figure.column);
    std::vector<double> values;
    for (const RunRecord* run : runs) {
      const CsvValue value = column->get(*run);
      if (const double* number = std::get_if<double>(&value)) values.push_back(*number);
    }
    const auto result = figure.is_signed ? signed_estimate(values) : estimate(values);
    if (result) figures.emplace(figure.column, *result);
  }
  return figures;
}

// The seeds that count.
Members chosen(const Members& members) {
  Members finished, furthest;
  for (const RunRecord* run : members) {
    if (run->final_errors() == nullptr) continue;
    if (run->status == "finished") {
      finished.push_back(run);
    } else if (furthest.empty() || run->frames.size() >= furthest.front()->frames.size()) {
      if (!furthest.empty() && run->frames.size() > furthest.front()->frames.size()) furthest.clear();
      furthest.push_back(run);
    }
  }
  return finished.empty() ? furthest : finished;
}

Cell make_cell(const Members& members) {
  const RunRecord& first = *members.front();
  Cell cell;
  cell.name = first.run.cell;
  cell.scene = first.scene;
  cell.labels = first.run.labels;
  cell.planned_frames = first.run.config.frames;
  cell.clamp_radiance = first.run.config.render.clamp_radiance;
  cell.runs = members.size();
  const Members counted = chosen(members);
  cell.frames = counted.empty() ? cell.planned_frames : static_cast<int>(counted.front()->frames.size());
  std::vector<double> relmse, elapsed, inefficiency, filtered, fireflies, bias;
  for (const RunRecord* run : members) {
    cell.non_finite += run->totals().non_finite;
    cell.clamped_samples += run->totals().clamped_samples;
    if (run->verdict) ++cell.verdicts[run->verdict->word];
  }
  for (const RunRecord* run : counted) {
    const ErrorMetrics* errors = run->final_errors();
    relmse.push_back(errors->relmse);
    elapsed.push_back(run->elapsed_s());
    inefficiency.push_back(*run->relmse_x_seconds());
    if (const FilteredRecord* record = run->final_filtered()) filtered.push_back(record->errors.relmse);
    if (const auto rate = run->fireflies_per_million()) fireflies.push_back(*rate);
    bias.push_back(run->last_snapshot()->clamp_bias);
    if (errors->at_reference_floor()) ++cell.at_reference_floor;
  }
  cell.finished = counted.size();
  cell.host_ms = pooled_times(counted, &RunRecord::host_ms);
  cell.gpu_ms = pooled_times(counted, &RunRecord::gpu_ms);
  cell.relmse = estimate(relmse);
  cell.elapsed_s = estimate(elapsed);
  cell.relmse_x_s = estimate(inefficiency);
  cell.relmse_filtered = estimate(filtered);
  cell.fireflies_per_million = estimate(fireflies);
  cell.clamp_bias = signed_estimate(bias);
  cell.members = counted;
  cell.figures = estimate_figures(counted);
  return cell;
}

}  // namespace

std::vector<Cell> collect_cells(const std::vector<RunRecord>& records) {
  std::vector<std::pair<std::string, Members>> groups;
  for (const RunRecord& record : records) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&record](const auto& entry) { return entry.first == record.run.cell; });
    if (group == groups.end()) group = groups.insert(groups.end(), {record.run.cell, {}});
    group->second.push_back(&record);
  }
  std::vector<Cell> cells;
  for (const auto& [name, members] : groups) cells.push_back(make_cell(members));
  return cells;
}

}  // namespace qtrace::experiments
