// summary.md: what an experiment found, for people.
#pragma once

#include "experiments/config/experiment_config.h"
#include "experiments/records/records.h"
#include "experiments/reference/reference.h"

#include <map>
#include <string>
#include <vector>

namespace qtrace::experiments {

// Markdown: per scene one table with a row per configuration, published figures and ratios beside the
// measured ones, then the references and what the columns hold.
std::string experiment_table(const Experiment& experiment, const std::vector<RunRecord>& records,
                             const std::map<std::string, Reference>& references, const std::string& device);

}  // namespace qtrace::experiments
