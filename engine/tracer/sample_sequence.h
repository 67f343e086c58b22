// Which random numbers a frame draws from where they are Sobol' points, and what it counts for.
#pragma once

#include "engine/core/settings.h"
#include "engine/tracer/learning_schedule.h"
#include "engine/tracer/trial.h"

#include <cstdint>

namespace qtrace {

// Point `index` of one of many sequences, each scrambled on its own.
struct SequencePlace {
  std::uint32_t sequence = 0;
  std::uint32_t index = 0;
};

// Frames fall into stretches. These end where something changes that earlier samples have decided: where the
// table is updated, and where its trial decides. Given the earlier points of its pixel, the next point of a
// sequence is not uniform, and these points have taught the table: with one sequence on both sides of an
// update the mean would be off. Each stretch therefore has sequences of its own; and within one, replicates
// have, and the two kinds of frames of a trial.
SequencePlace sequence_place(std::uint32_t frame, const RenderSettings& settings,
                             const LearningSchedule& schedule, const Trial& trial);

// Of a frame of the trial's pilot: each lesson has a sequence, and after these each kind of frames has two,
// which their pairs take in turn.
SequencePlace pilot_place(std::uint32_t frame, const Trial& trial);

// Of the frame in the image. With Sobol' points and a table the first frames count for less: their stretches
// are short, and a long net is worth more than its share of the samples. It depends on nothing but the
// frame's number and on what was known before the first frame, the pilot's findings among it, so that the
// mean stays without bias. Independent samples all count alike, as their variance is computed.
float frame_weight(std::uint32_t frame, const RenderSettings& settings, const Trial& trial);

}  // namespace qtrace
