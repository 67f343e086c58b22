// A run's record as JSON and back, without loss: what checkpoints hold, and what a finished run is read from.
#pragma once

#include "experiments/files/json.h"
#include "experiments/records/records.h"

namespace qtrace::experiments {

// All that was measured, as arrays of bare values in the order of their declarations: made for CBOR, read by
// this program alone. What the config says (run, place, order) is not in it.
Json pack(const RunRecord& record);

// Fills what pack() wrote into `record`. Throws Error where the JSON is not of that shape.
void unpack(const Json& json, RunRecord& record);

}  // namespace qtrace::experiments
