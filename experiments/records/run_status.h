// How far a run is, and how it ended.
#pragma once

#include "engine/core/knob.h"

#include <array>
#include <string_view>

namespace qtrace::experiments {

// Of a run: waiting for its turn; at work; ended with all its frames, or by an error; or stopped on the way
// with a checkpoint to go on from. An experiment is at work, finished, failed or partial in the same sense.
enum class RunStatus { waiting, running, finished, failed, partial };

}  // namespace qtrace::experiments

// As manifests, summary.csv and messages have it.
template <>
struct qtrace::EnumNames<qtrace::experiments::RunStatus> {
  static constexpr std::array<std::string_view, 5> values{"waiting", "running", "finished", "failed",
                                                          "partial"};
};
