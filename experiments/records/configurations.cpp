#include "experiments/records/configurations.h"

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
  for (const Figure& figure : run_figures()) {
    if (!figure.is_averaged) continue;
    std::vector<double> values;
    for (const RunRecord* run : runs) {
      const CsvValue value = figure.column.get(*run);
      if (const double* number = std::get_if<double>(&value)) values.push_back(*number);
    }
    const auto result = figure.is_signed ? signed_estimate(values) : estimate(values);
    if (result) figures.emplace(figure.column.name, *result);
  }
  return figures;
}

// The seeds that count.
Members chosen(const Members& members) {
  Members finished, furthest;
  for (const RunRecord* run : members) {
    if (run->final_errors() == nullptr) continue;
    if (run->status == RunStatus::finished) {
      finished.push_back(run);
    } else if (furthest.empty() || run->frames.size() >= furthest.front()->frames.size()) {
      if (!furthest.empty() && run->frames.size() > furthest.front()->frames.size()) furthest.clear();
      furthest.push_back(run);
    }
  }
  return finished.empty() ? furthest : finished;
}

Configuration make_configuration(const Members& members) {
  const RunRecord& first = *members.front();
  Configuration configuration;
  configuration.name = first.run.configuration;
  configuration.scene = first.scene;
  configuration.labels = first.run.labels;
  configuration.planned_frames = first.run.config.frames;
  configuration.clamp_radiance = first.run.config.render.clamp_radiance;
  configuration.runs = members.size();
  const Members counted = chosen(members);
  configuration.frames =
      counted.empty() ? configuration.planned_frames : static_cast<int>(counted.front()->frames.size());
  for (const RunRecord* run : members) {
    configuration.non_finite += run->totals().non_finite;
    configuration.clamped_samples += run->totals().clamped_samples;
    if (run->verdict) ++configuration.verdicts[run->verdict->word];
  }
  configuration.at_reference_floor = static_cast<std::size_t>(std::ranges::count_if(
      counted, [](const RunRecord* run) { return run->final_errors()->at_reference_floor(); }));
  configuration.finished = counted.size();
  configuration.host_ms = pooled_times(counted, &RunRecord::host_ms);
  configuration.gpu_ms = pooled_times(counted, &RunRecord::gpu_ms);
  configuration.members = counted;
  configuration.figures = estimate_figures(counted);
  return configuration;
}

}  // namespace

std::optional<Estimate> Configuration::figure(const std::string& column) const {
  const auto found = figures.find(column);
  return found == figures.end() ? std::nullopt : std::optional(found->second);
}

std::vector<Configuration> collect_configurations(const std::vector<RunRecord>& records) {
  std::vector<std::pair<std::string, Members>> groups;
  for (const RunRecord& record : records) {
    auto group = std::find_if(groups.begin(), groups.end(), [&record](const auto& entry) {
      return entry.first == record.run.configuration;
    });
    if (group == groups.end()) group = groups.insert(groups.end(), {record.run.configuration, {}});
    group->second.push_back(&record);
  }
  std::vector<Configuration> configurations;
  for (const auto& [name, members] : groups) configurations.push_back(make_configuration(members));
  return configurations;
}

}  // namespace qtrace::experiments
