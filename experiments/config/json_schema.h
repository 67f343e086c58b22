// A JSON Schema (draft 2020-12) of configs, made from the declarations of the knobs: editors complete and
// check with it. What depends on several keys at once (snapshots in order, a seed that differs from the
// reference's, a baseline that exists) only `qtrace config check` knows.
#pragma once

#include "experiments/files/json.h"

namespace qtrace::experiments {

Json config_schema();

}  // namespace qtrace::experiments
