#include "experiments/records/summary_page.h"

#include "experiments/records/frame_times.h"
#include "experiments/records/ratios.h"
#include "experiments/records/summary_tables.h"
#include "experiments/runtime/manifest.h"

#include <algorithm>
#include <functional>
#include <string_view>

namespace qtrace::experiments {
namespace {

// The configuration that differs from `configuration` in one label alone: `from` there, `to` here.
const Configuration* counterpart(const Configuration& configuration,
                                 const std::vector<const Configuration*>& configurations,
                                 const std::string& from, const std::string& to) {
  std::vector<std::string> wanted = configuration.labels;
  const auto place = std::find(wanted.begin(), wanted.end(), from);
  if (place == wanted.end()) return nullptr;
  *place = to;
  const auto found = std::find_if(configurations.begin(), configurations.end(),
                                  [&wanted](const Configuration* other) { return other->labels == wanted; });
  return found == configurations.end() ? nullptr : *found;
}

std::string ratio_line(const Experiment& experiment, const Configuration& above, const Configuration& below) {
  std::string line = fmt::format("- {} over {}: ", above.name, below.name);
  line += above.host_ms && below.host_ms
              ? fmt::format("{:.3g} × the host time per frame", above.host_ms->median / below.host_ms->median)
              : "not measured";
  const double* above_ms = experiment.published.ms_per_frame.find(above.name);
  const double* below_ms = experiment.published.ms_per_frame.find(below.name);
  if (above_ms != nullptr && below_ms != nullptr) {
    line += fmt::format(" (published: {:.2f} ×)", *above_ms / *below_ms);
  }
  const auto above_error = above.figure("relmse_x_s");
  const auto below_error = below.figure("relmse_x_s");
  if (above_error && below_error) {
    line += fmt::format("; {:.3g} × the relMSE × s", above_error->mean / below_error->mean);
  }
  return line + '\n';
}

std::string ratio_lines(const Experiment& experiment,
                        const std::vector<const Configuration*>& configurations) {
  std::string lines;
  const auto& [above_label, below_label] = experiment.published.ratio;
  if (above_label.empty() || below_label.empty()) return lines;
  for (const Configuration* configuration : configurations) {
    const Configuration* below = counterpart(*configuration, configurations, above_label, below_label);
    if (below != nullptr) lines += ratio_line(experiment, *configuration, *below);
  }
  return lines.empty() ? lines : '\n' + lines;
}

std::string clamping_lines(const std::vector<const Configuration*>& configurations) {
  std::string lines;
  for (const Configuration* configuration : configurations) {
    if (configuration->clamp_radiance == 0) continue;
    lines += fmt::format(
        "- {}: clamped (biased): clamp_radiance {:g} scaled down {} samples and changed the mean by {}\n",
        configuration->name, configuration->clamp_radiance, configuration->clamped_samples,
        estimate_text(configuration->figure("clamp_bias")));
  }
  return lines.empty() ? lines : '\n' + lines;
}

std::string reference_lines(const std::map<std::string, Reference>& references) {
  if (references.empty()) return "";
  std::string lines = "\nReferences:\n";
  for (const auto& [hash, reference] : references) {
    const RenderSettings& settings = reference.spec.settings;
    lines += fmt::format(
        "- {}: {} frames of {}×{}, sampler {}, nee {}, lights {}, seed {} ({}), noise in relMSE {:.3g}, in "
        "MSE {:.3g}, "
        "hash {}\n",
        reference.scene, reference.samples, settings.width, settings.height, enum_name(settings.sampler),
        enum_name(settings.nee), enum_name(settings.lights), settings.seed, reference.origin,
        reference.noise.relmse, reference.noise.mse, hash);
    if (const std::string warning = noise_warning(reference); !warning.empty()) {
      lines += fmt::format("  (Warning: {})\n", warning);
    }
    if (reference.non_finite > 0) {
      lines += fmt::format("  ({} samples of it were not finite and count as 0)\n", reference.non_finite);
    }
  }
  return lines;
}

// Errors of Sobol' points fall faster than 1/spp: that is what they are for.
bool has_sobol_points(const Configuration& configuration) {
  return std::ranges::any_of(configuration.members, [](const RunRecord* run) {
    return run->run.config.render.random == RandomNumbers::sobol;
  });
}

// Where the interval of a slope lies beyond this distance from -1, something is worth a look.
constexpr double kSlopeTolerance = 0.1;

std::string slope_lines(const std::vector<Configuration>& configurations) {
  std::string lines;
  for (const Configuration& configuration : configurations) {
    for (const Metric& metric : error_metrics()) {
      const auto slope = configuration.figure("slope_" + metric.name);
      if (!slope || !slope->low) continue;
      const bool is_steep = *slope->high < -1 - kSlopeTolerance && !has_sobol_points(configuration);
      const bool is_flat = *slope->low > -1 + kSlopeTolerance;
      if (!is_steep && !is_flat) continue;
      lines += fmt::format("- {}: slope_{} against spp {}: {}\n", configuration.name, metric.name,
                           estimate_text(slope),
                           is_steep ? "steeper than -1: still learning, or rare bright samples came early"
                                    : "flatter than -1: biased, heavy-tailed, or near the reference's noise");
    }
  }
  return lines.empty() ? lines : "\nErrors that do not fall as 1/spp:\n" + lines;
}

// Where seeds decided differently, a configuration is a mixture of two kinds of runs. `key`: of the trial;
// `they`: the pronoun for what a run keeps.
std::string given_up_lines(const std::vector<Configuration>& configurations, std::string_view what,
                           std::string_view they, std::string_view key,
                           const std::function<bool(const RunRecord*)>& gave_up) {
  std::string lines;
  for (const Configuration& configuration : configurations) {
    const auto without = std::ranges::count_if(configuration.members, gave_up);
    if (without == 0) continue;
    const auto seeds = static_cast<std::ptrdiff_t>(configuration.members.size());
    const std::string mixture = fmt::format(
        "; the others kept {}, and intervals over few runs of two kinds are too narrow: raise the "
        "number of seeds, or set {} to 0",
        they, key);
    lines += fmt::format("- {}: given up by {} of {} runs{}\n", configuration.name, without, seeds,
                         without == seeds ? "" : mixture);
  }
  return lines.empty() ? lines : fmt::format("\n{} given up after their trial ({}):\n{}", what, key, lines);
}

std::string trial_lines(const std::vector<Configuration>& configurations) {
  return given_up_lines(configurations, "Tables", "it", "rl.trial_frames",
                        [](const RunRecord* run) { return run->table_given_up.has_value(); }) +
         given_up_lines(configurations, "Light paths", "them", "light_path_trial",
                        [](const RunRecord* run) { return run->light_paths_given_up; });
}

std::string time_lines(const std::vector<RunRecord>& records) {
  const std::string lines = time_warnings(records);
  return lines.empty() ? lines : "\nTimes to be careful with:\n" + lines;
}

std::string failure_lines(const std::vector<RunRecord>& records) {
  std::string lines;
  for (const RunRecord& record : records) {
    if (record.status == RunStatus::failed) lines += fmt::format("- {}: {}\n", record.run.id, record.reason);
  }
  return lines.empty() ? lines : "\nFailed runs:\n" + lines;
}

std::string unfinished_lines(const Experiment& experiment, const std::vector<RunRecord>& records) {
  const auto partial = std::ranges::count(records, RunStatus::partial, &RunRecord::status);
  const std::size_t missing = experiment.runs.size() - records.size();
  if (partial == 0 && missing == 0) return "";
  return fmt::format(
      "\nNot finished: {} runs stopped on the way (what they have is shown where no seed of their "
      "configuration is "
      "finished), "
      "{} not begun, of {}.\n",
      partial, missing, experiment.runs.size());
}

std::string verdict_lines(const std::vector<RunRecord>& records) {
  std::string lines;
  for (const RunRecord& record : records) {
    if (!record.verdict || record.verdict->reason.empty()) continue;
    lines += fmt::format("- {}: {}\n", record.run.id, record.verdict->reason);
  }
  return lines.empty() ? lines : "\nRuns that are not as expected:\n" + lines;
}

std::string notes(const Experiment& experiment) {
  std::string text = "\n" + timing_note() + "\n\n";
  const bool seeds = std::any_of(experiment.axes.begin(), experiment.axes.end(),
                                 [](const Axis& axis) { return axis.is_seed; });
  text += fmt::format(
      "ms/frame: median [10th, 90th percentile] over the frames of all seeds. relMSE, s (host time of all "
      "frames) and their product: at the last frame, mean over seeds{}. Fireflies: samples brighter than "
      "firefly_multiple times their pixel's reference. Non-finite: samples. At floor: seeds "
      "whose error is within {} times the reference's own noise.\n",
      seeds ? " [95 % confidence interval]" : "", kReferenceFloor);
  if (std::ranges::any_of(experiment.runs,
                          [](const Run& run) { return run.config.filter.kind != FilterKind::none; })) {
    text +=
        "\nRows marked à-trous: the images of the row above after the filter, which is biased. Its time is "
        "filter_ms in summary.csv and in no other time.\n";
  }
  if (!experiment.baseline.empty()) {
    text +=
        "\nRatios to the baseline: means over seeds, with 95 % intervals as if the seeds of the two were "
        "independent. Time to the baseline's relMSE: until the configuration's mean error is what the "
        "baseline has at its end, between snapshots by straight lines in the logarithms; '-' where it was "
        "never reached, or before the first snapshot. For this and for relMSE at equal seconds, where both "
        "have "
        "the same seeds, five or more, the interval comes from pairs of runs with the same seed, which took "
        "turns on the machine.\n";
  }
  if (!experiment.published.source.empty()) text += "\nPublished: " + experiment.published.source + "\n";
  if (!experiment.published.note.empty()) text += "\n" + experiment.published.note + "\n";
  return text;
}

}  // namespace

std::string experiment_table(const Experiment& experiment, const std::vector<RunRecord>& records,
                             const std::map<std::string, Reference>& references, const std::string& device) {
  const std::vector<Configuration> configurations = collect_configurations(records);
  std::vector<std::pair<std::string, std::vector<const Configuration*>>> scenes;
  for (const Configuration& configuration : configurations) {
    auto scene = std::find_if(scenes.begin(), scenes.end(), [&configuration](const auto& entry) {
      return entry.first == configuration.scene;
    });
    if (scene == scenes.end()) scene = scenes.insert(scenes.end(), {configuration.scene, {}});
    scene->second.push_back(&configuration);
  }
  const std::vector<Ratios> ratios = baseline_ratios(experiment, configurations);
  std::string text = fmt::format("# {}\n\nDevice: {}\n", experiment.name, device);
  for (const auto& [scene, rows] : scenes) {
    text += fmt::format("\n## {}\n\n", scene) + configuration_table(experiment, rows) +
            ratio_lines(experiment, rows) + ratio_table(ratios, scene) + clamping_lines(rows);
  }
  return text + slope_lines(configurations) + trial_lines(configurations) + time_lines(records) +
         failure_lines(records) + unfinished_lines(experiment, records) + verdict_lines(records) +
         reference_lines(references) + notes(experiment);
}

}  // namespace qtrace::experiments
