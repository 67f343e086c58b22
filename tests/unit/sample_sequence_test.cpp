// Which sequence a frame draws from, and what it weighs, against what was worked out by hand.
#include "engine/tracer/sample_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace qtrace {
namespace {

RenderSettings sobol(Sampler sampler, int replicates = 1, int trial_frames = 0) {
  RenderSettings settings;
  settings.random = RandomNumbers::sobol;
  settings.sampler = sampler;
  settings.replicates = replicates;
  settings.rl.trial_frames = trial_frames;
  return settings;
}

// The frames of each sequence among the first `frames`, in the order of their points.
std::vector<std::vector<std::uint32_t>> sequences(const RenderSettings& settings, std::uint32_t frames) {
  const LearningSchedule schedule(settings, 1U << 20);
  const TableTrial trial(settings);
  std::map<std::uint32_t, std::vector<std::uint32_t>> found;
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    const SequencePlace place = sequence_place(frame, settings, schedule, trial);
    EXPECT_EQ(place.index, found[place.sequence].size()) << frame;
    found[place.sequence].push_back(frame);
  }
  std::vector<std::vector<std::uint32_t>> in_order;
  for (const auto& [sequence, its_frames] : found) in_order.push_back(its_frames);
  return in_order;
}

using Frames = std::vector<std::vector<std::uint32_t>>;

TEST(SampleSequence, IsOneWhereNothingIsLearned) {
  EXPECT_EQ(sequences(sobol(Sampler::bsdf), 6), (Frames{{1, 2, 3, 4, 5, 6}}));
}

TEST(SampleSequence, ReplicatesTakeTurns) {
  EXPECT_EQ(sequences(sobol(Sampler::bsdf, 2), 7), (Frames{{1, 3, 5, 7}, {2, 4, 6}}));
}

TEST(SampleSequence, StartsAnewAtEveryUpdateOfTheTable) {
  EXPECT_EQ(sequences(sobol(Sampler::rl), 10), (Frames{{1}, {2}, {3, 4}, {5, 6, 7, 8}, {9, 10}}));
  EXPECT_EQ(sequences(sobol(Sampler::rl, 2), 8), (Frames{{1}, {2}, {3}, {4}, {5, 7}, {6, 8}}));
}

// In a round, both kinds of frames and both halves have their own.
TEST(SampleSequence, IsNotSharedByTheKindsOfFramesOfATrial) {
  EXPECT_EQ(
      sequences(sobol(Sampler::rl, 1, 4), 20),
      (Frames{{1}, {2}, {3, 4}, {5}, {6}, {7}, {8}, {9, 10, 11, 12, 13, 14, 15, 16}, {17, 19}, {18, 20}}));
}

// After the table was given up nothing changes any more: one sequence to the end, though the table's updates
// would go on.
TEST(SampleSequence, GoesOnWithoutATableThatWasGivenUp) {
  const RenderSettings settings = sobol(Sampler::rl, 1, 4);
  const LearningSchedule schedule(settings, 1U << 20);
  TableTrial trial(settings);
  HalfSums black{std::vector<glm::dvec3>(64), std::vector<glm::dvec3>(64)};
  FrameCounters counters;
  for (const std::uint32_t frame : {4U, 6U, 7U, 8U}) {
    counters.rays = frame == 8 ? 20 : 10;
    trial.look({frame, 1, 8, black, counters});
  }
  ASSERT_TRUE(trial.gave_up());
  const std::uint32_t sequence = sequence_place(9, settings, schedule, trial).sequence;
  for (const std::uint32_t frame : {16U, 17U, 33U, 100U, 1000U}) {
    const SequencePlace place = sequence_place(frame, settings, schedule, trial);
    EXPECT_EQ(place.sequence, sequence);
    EXPECT_EQ(place.index, frame - 9);
  }
  EXPECT_NE(sequence_place(8, settings, schedule, trial).sequence, sequence);
}

TEST(SampleSequence, WeighsFramesOfShortStretchesLess) {
  const RenderSettings settings = sobol(Sampler::rl);
  for (const auto& [frame, weight] : std::map<std::uint32_t, double>{{1, 0.25},
                                                                     {2, 0.25},
                                                                     {3, std::sqrt(0.125)},
                                                                     {4, std::sqrt(0.125)},
                                                                     {5, 0.5},
                                                                     {8, 0.5},
                                                                     {9, std::sqrt(0.5)},
                                                                     {16, std::sqrt(0.5)},
                                                                     {17, 1},
                                                                     {1000, 1}}) {
    EXPECT_FLOAT_EQ(frame_weight(frame, settings), static_cast<float>(weight)) << frame;
  }
  EXPECT_EQ(frame_weight(1, sobol(Sampler::bsdf)), 1);
  EXPECT_EQ(frame_weight(1, RenderSettings{}), 1);
}

}  // namespace
}  // namespace qtrace
