#include "experiments/records/summary_tables.h"

#include "experiments/files/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace qtrace::experiments {
namespace {

constexpr const char* kNothing = "-";
constexpr const char* kFiltered = "à-trous (biased)";

// Three digits, but never fewer than stand before the point.
std::string three_digits(double value) {
  return value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string times_text(const std::optional<FrameTimes>& times) {
  if (!times) return kNothing;
  return fmt::format("{} [{}, {}]", three_digits(times->median), three_digits(times->p10),
                     three_digits(times->p90));
}

std::string fraction_text(std::size_t part, std::size_t whole) {
  return part == whole ? std::to_string(whole) : fmt::format("{}/{}", part, whole);
}

std::string frames_text(const Configuration& configuration) {
  return configuration.frames == configuration.planned_frames
             ? std::to_string(configuration.frames)
             : fmt::format("{} of {}", configuration.frames, configuration.planned_frames);
}

std::string seeds_text(const Configuration& configuration) {
  return fraction_text(configuration.finished, configuration.runs);
}

std::string floor_text(const Configuration& configuration) {
  return configuration.at_reference_floor == 0
             ? "no"
             : fmt::format("{} of {}", configuration.at_reference_floor, configuration.finished);
}

// "pass", or "fail 2, pass 3" where seeds differ.
std::string verdict_text(const Configuration& configuration) {
  std::string text;
  for (const auto& [word, seeds] : configuration.verdicts) {
    text += text.empty() ? "" : ", ";
    text += configuration.verdicts.size() == 1 ? word : fmt::format("{} {}", word, seeds);
  }
  return text.empty() ? kNothing : text;
}

std::string published_text(const Experiment& experiment, const Configuration& configuration) {
  const double* ms = experiment.published.ms_per_frame.find(configuration.name);
  return ms == nullptr ? kNothing : fmt::format("{:g}", *ms);
}

std::string nothing_text(const Configuration&) { return kNothing; }

using Text = std::function<std::string(const Configuration&)>;

struct TableColumn {
  std::string name;
  Text plain;
  Text filtered = nothing_text;  // in the row of the filtered image
};

std::vector<TableColumn> table_columns(const Experiment& experiment, bool some_filter, bool some_verdict) {
  std::vector<TableColumn> columns{
      {"frames", frames_text, frames_text},
      {"seeds", seeds_text, seeds_text},
      {"host ms/frame", [](const Configuration& configuration) { return times_text(configuration.host_ms); }},
      {"GPU ms/frame", [](const Configuration& configuration) { return times_text(configuration.gpu_ms); }},
  };
  if (!experiment.published.ms_per_frame.by_configuration.empty()) {
    columns.push_back({"published ms", [&experiment](const Configuration& configuration) {
                         return published_text(experiment, configuration);
                       }});
  }
  columns.push_back({"relMSE", [](const Configuration& configuration) {
                       return estimate_text(configuration.figure("relmse"));
                     }});
  if (some_filter) {
    columns.push_back({"relMSE filtered (biased)", nothing_text, [](const Configuration& configuration) {
                         return estimate_text(configuration.figure("filtered_relmse"));
                       }});
  }
  columns.insert(
      columns.end(),
      {{"s",
        [](const Configuration& configuration) {
          const auto seconds = configuration.figure("elapsed_s");
          return seconds ? three_digits(seconds->mean) : kNothing;
        }},
       {"relMSE × s",
        [](const Configuration& configuration) { return estimate_text(configuration.figure("relmse_x_s")); }},
       {"fireflies / M samples",
        [](const Configuration& configuration) {
          return estimate_text(configuration.figure("fireflies_per_million"));
        }},
       {"non-finite",
        [](const Configuration& configuration) { return std::to_string(configuration.non_finite); }},
       {"at floor", floor_text}});
  if (some_verdict) columns.push_back({"verdict", verdict_text});
  return columns;
}

// Axes that tell the rows of one scene's table apart.
std::vector<std::size_t> row_axes(const Experiment& experiment) {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < experiment.axes.size(); ++i) {
    if (!experiment.axes[i].is_seed && experiment.axes[i].name != "scene") axes.push_back(i);
  }
  return axes;
}

std::string text_with_ends(double value, const std::optional<double>& low,
                           const std::optional<double>& high) {
  return low ? fmt::format("{:.3g} [{:.3g}, {:.3g}]", value, *low, *high) : fmt::format("{:.3g}", value);
}

std::string interval_text(const std::optional<Interval>& interval) {
  return interval ? text_with_ends(interval->value, interval->low, interval->high) : kNothing;
}

}  // namespace

std::string estimate_text(const std::optional<Estimate>& value) {
  return value ? text_with_ends(value->mean, value->low, value->high) : kNothing;
}

std::string configuration_table(const Experiment& experiment,
                                const std::vector<const Configuration*>& configurations) {
  const std::vector<std::size_t> axes = row_axes(experiment);
  const bool some_filter = std::ranges::any_of(configurations, [](const Configuration* configuration) {
    return configuration->figure("filtered_relmse").has_value();
  });
  const bool some_verdict = std::ranges::any_of(
      configurations, [](const Configuration* configuration) { return !configuration->verdicts.empty(); });
  const std::vector<TableColumn> columns = table_columns(experiment, some_filter, some_verdict);
  std::vector<std::string> header;
  for (const std::size_t axis : axes) header.push_back(experiment.axes[axis].name);
  if (axes.empty() && some_filter) header.emplace_back("image");
  const std::size_t labels = header.size();
  for (const TableColumn& column : columns) header.push_back(column.name);
  std::vector<std::vector<std::string>> rows;
  const auto add_row = [&](const Configuration& configuration, Text TableColumn::*text) {
    const bool is_filtered = text == &TableColumn::filtered;
    std::vector<std::string>& row = rows.emplace_back();
    for (const std::size_t axis : axes) row.push_back(configuration.labels[axis]);
    if (row.size() < labels)
      row.emplace_back(is_filtered ? kFiltered : "mean");
    else if (is_filtered)
      row.back() += std::string(", ") + kFiltered;
    for (const TableColumn& column : columns) row.push_back((column.*text)(configuration));
  };
  for (const Configuration* configuration : configurations) {
    add_row(*configuration, &TableColumn::plain);
    if (configuration->figure("filtered_relmse")) add_row(*configuration, &TableColumn::filtered);
  }
  return markdown_table(header, rows, labels);
}

std::string ratio_table(const std::vector<Ratios>& ratios, const std::string& scene) {
  std::vector<std::string> header{"configuration", "baseline"};
  const std::size_t labels = header.size();
  for (const Figure& figure : run_figures()) {
    if (figure.is_compared) header.push_back(figure.label);
  }
  header.emplace_back("relMSE at equal seconds");
  header.emplace_back("time to the baseline's relMSE");
  std::vector<std::vector<std::string>> rows;
  for (const Ratios& ratio : ratios) {
    if (ratio.scene != scene) continue;
    std::vector<std::string>& row = rows.emplace_back();
    row = {ratio.configuration, ratio.baseline};
    for (const Figure& figure : run_figures()) {
      if (figure.is_compared) row.push_back(interval_text(ratio.figure(figure.column.name)));
    }
    row.push_back(interval_text(ratio.equal_seconds.at("relmse_corrected")));
    row.push_back(interval_text(ratio.times.at("relmse").ratio));
  }
  if (rows.empty()) return "";
  return "\nThe baseline's figure divided by the configuration's; above 1, the baseline needs more:\n\n" +
         markdown_table(header, rows, labels);
}

}  // namespace qtrace::experiments
