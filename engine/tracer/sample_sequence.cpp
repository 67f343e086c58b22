#include "engine/tracer/sample_sequence.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace qtrace {
namespace {

// Of a stretch; more than there can be replicates, each for both kinds of frames of a trial.
constexpr std::uint32_t kMostSequences = 128;
// Of frames that are tried: two kinds of frames in turn, two pairs of them in turn.
constexpr std::uint32_t kTriedSequences = 4;
// Frames after which all count alike.
constexpr std::uint32_t kFullWeight = 16;

std::uint32_t stretch_start(std::uint32_t frame, const RenderSettings& settings,
                            const LearningSchedule& schedule, const Trial& trial) {
  if (!has_table(settings)) return 0;
  const std::uint32_t before = frame - 1;
  const std::uint32_t learned = trial.gave_up() ? std::min(before, trial.finding()->frame) : before;
  return std::max(schedule.last_update(learned), trial.last_boundary(before));
}

}  // namespace

SequencePlace sequence_place(std::uint32_t frame, const RenderSettings& settings,
                             const LearningSchedule& schedule, const Trial& trial) {
  const std::uint32_t start = stretch_start(frame, settings, schedule, trial);
  const auto replicates = static_cast<std::uint32_t>(settings.replicates);
  const std::uint32_t sequences = trial.is_tried(frame) ? std::lcm(replicates, kTriedSequences) : replicates;
  return {start * kMostSequences + (frame - 1) % sequences, (frame - 1 - start) / sequences};
}

SequencePlace pilot_place(std::uint32_t frame, const Trial& trial) {
  const std::uint32_t lessons = trial.pilot_lessons();
  if (frame <= lessons) return {frame, 0};
  const std::uint32_t tried = frame - lessons - 1;
  return {lessons + 1 + tried % kTriedSequences, tried / kTriedSequences};
}

float frame_weight(std::uint32_t frame, const RenderSettings& settings, const Trial& trial) {
  if (settings.random != RandomNumbers::sobol || !has_table(settings)) return 1;
  if (trial.gave_up() && trial.finding()->frame == 0) return 1;
  const auto tried = static_cast<float>(trial.weight(frame));
  if (frame > kFullWeight) return tried;
  const std::uint32_t doubling = frame < 2 ? 1 : std::bit_floor(frame - 1);
  return tried * std::sqrt(static_cast<float>(doubling) / static_cast<float>(kFullWeight));
}

}  // namespace qtrace
