#include "engine/tracer/learning_schedule.h"

#include <algorithm>
#include <cmath>

namespace qtrace {
namespace {

// Frames that have taught after `frame` frames, of which the first n all do: the integral of min(1, n / f).
double taught(double frame, double n) { return frame <= n ? frame : n * (1 + std::log(frame / n)); }

}  // namespace

bool LearningSchedule::teaches(std::uint32_t frame) const {
  if (teach_frames_ == 0 || frame <= static_cast<std::uint32_t>(teach_frames_)) return true;
  return std::floor(taught(frame, teach_frames_)) > std::floor(taught(frame - 1, teach_frames_));
}

bool LearningSchedule::updates(std::uint32_t frame) const {
  std::uint32_t update = 0;
  while (update < frame) {
    const auto step = static_cast<std::uint32_t>(std::min(growth_ * update, 1.0 * most_));
    if (step == most_) return (frame - update) % step == 0;
    update += std::max(step, 1U);
  }
  return update == frame;
}

}  // namespace qtrace
