// What a run's manifest says before anything is rendered.
#pragma once

#include "experiments/files/json.h"
#include "experiments/run/run.h"

namespace qtrace::experiments {

// `record`: hashes and the start of the run.
Json first_manifest(const RunJob& job, const RunRecord& record);

}  // namespace qtrace::experiments
