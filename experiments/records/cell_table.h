// The rows of table.md.
#pragma once

#include "experiments/records/cells.h"
#include "experiments/config/experiment_config.h"

#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// "0.0329 [0.0317, 0.0342]", or "-" where there is nothing.
std::string estimate_text(const std::optional<Estimate>& value);

// Markdown: a row per cell, and one below it for its filtered image where it has one. Filtered errors stand
// in a column of their own, which is there only if some cell has them.
std::string cell_table(const Experiment& experiment, const std::vector<const Cell*>& cells);

}  // namespace qtrace::experiments
