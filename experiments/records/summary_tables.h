// The tables of summary.md.
#pragma once

#include "experiments/config/experiment_config.h"
#include "experiments/records/configurations.h"
#include "experiments/records/ratios.h"

#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// "0.0329 [0.0317, 0.0342]", or "-" where there is nothing.
std::string estimate_text(const std::optional<Estimate>& value);

// Markdown: a row per configuration, and one below it for its filtered image where it has one. Filtered
// errors stand in a column of their own, which is there only if some configuration has them.
std::string configuration_table(const Experiment& experiment,
                                const std::vector<const Configuration*>& configurations);

// A Markdown table of the ratios of one scene, or nothing.
std::string ratio_table(const std::vector<Ratios>& ratios, const std::string& scene);

}  // namespace qtrace::experiments
