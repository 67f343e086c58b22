#include "engine/tracer/learning_schedule.h"

#include <algorithm>
#include <cmath>

namespace qtrace {

// Frames that have taught after `frame` frames, rounded down: of which the first n all do, and of later ones
// the integral of n / f.
double LearningSchedule::taught(double frame) const {
  const double n = teach_frames_;
  if (teach_frames_ == 0 || frame <= n) return frame;
  return std::floor(n * (1 + std::log(frame / n)));
}

bool LearningSchedule::teaches(std::uint32_t frame) const { return taught(frame) > taught(frame - 1.0); }

std::uint32_t LearningSchedule::next_step(std::uint32_t update) const {
  if (!doubles_) {
    const auto step = static_cast<std::uint32_t>(std::min(growth_ * update, 1.0 * kMostFramesPerUpdate));
    return std::clamp(step, 1U, most_taught_);
  }
  // The largest power of two that divides it: what starts there is whole again after that many frames.
  std::uint32_t step = std::max(1U, update & (0U - update));
  while (step > 1 && taught(update + step) - taught(update) > most_taught_) step /= 2;
  return step;
}

std::uint32_t LearningSchedule::last_update(std::uint32_t frame) const {
  const std::uint32_t longest = std::min(kMostFramesPerUpdate, most_taught_);
  std::uint32_t update = 0;
  for (std::uint32_t step = next_step(0); update + step <= frame; step = next_step(update)) {
    if (!doubles_ && step == longest) return update + (frame - update) / step * step;
    update += step;
  }
  return update;
}

}  // namespace qtrace
