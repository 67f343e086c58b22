// Which sequence a frame draws from, and what it weighs, against what was worked out by hand.
#include "engine/tracer/sample_sequence.h"

#include <gtest/gtest.h>

#include <array>
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
  const Trial trial = trial_of_table(settings);
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

// In a round, both kinds of frames have two each.
TEST(SampleSequence, IsNotSharedByTheKindsOfFramesOfATrial) {
  Frames expected{{1}, {2}, {3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12, 13, 14, 15, 16}};
  for (const std::uint32_t first : {17U, 18U, 19U, 20U})
    expected.push_back({first, first + 4, first + 8, first + 12});
  EXPECT_EQ(sequences(sobol(Sampler::rl, 1, 4), 32), expected);
}

// Lessons have sequences of their own, as the table is updated after most; then it stands still.
TEST(SampleSequence, OfThePilotIsThatOfALessonOrOneOfTwoOfAKind) {
  const Trial trial = trial_of_table(sobol(Sampler::rl, 1, 4));
  std::map<std::uint32_t, std::vector<std::uint32_t>> found;
  for (std::uint32_t frame = 1; frame <= trial.pilot_frames(); ++frame) {
    const SequencePlace place = pilot_place(frame, trial);
    EXPECT_EQ(place.index, found[place.sequence].size()) << frame;
    found[place.sequence].push_back(frame);
  }
  Frames in_order;
  for (const auto& [sequence, its_frames] : found) in_order.push_back(its_frames);
  EXPECT_EQ(in_order, (Frames{{1},
                              {2},
                              {3},
                              {4},
                              {5},
                              {6},
                              {7},
                              {8},
                              {9, 13, 17, 21},
                              {10, 14, 18, 22},
                              {11, 15, 19, 23},
                              {12, 16, 20, 24}}));
}

// Pixels of both kinds after some pairs of frames, which are a tenth brighter than 1 and darker in turn:
// nothing is gained.
HalfSums sums_after(std::uint32_t pairs) {
  const float value = static_cast<float>(pairs) + (pairs % 2 == 1 ? 0.1F : 0);
  const std::vector<glm::vec3> pixels(256, glm::vec3(value));
  return {pixels, pixels};
}

// Its table takes twice the work. The pilot knows that half-way.
void give_up(Trial& trial) {
  FrameCounters without, with_table;
  without.rays = 10;
  with_table.rays = 20;
  for (std::uint32_t frame = 10; frame <= 16; frame += 2)
    trial.look_at_pilot({frame, 16, sums_after((frame - 8) / 2), {without, with_table}});
}

// A table that was given up before the first frame leaves one sequence, and all frames alike.
TEST(SampleSequence, IsOneWithoutATableThatWasGivenUp) {
  const RenderSettings settings = sobol(Sampler::rl, 1, 4);
  const LearningSchedule schedule(settings, 1U << 20);
  Trial trial = trial_of_table(settings);
  give_up(trial);
  ASSERT_TRUE(trial.gave_up());
  for (const std::uint32_t frame : {1U, 2U, 16U, 17U, 33U, 100U, 1000U}) {
    const SequencePlace place = sequence_place(frame, settings, schedule, trial);
    EXPECT_EQ(place.sequence, 0U);
    EXPECT_EQ(place.index, frame - 1);
    EXPECT_EQ(frame_weight(frame, settings, trial), 1);
  }
}

// After a round has given the table up nothing changes any more: one sequence to the end, though the table's
// updates would go on.
TEST(SampleSequence, GoesOnWithoutATableThatARoundGaveUp) {
  const RenderSettings settings = sobol(Sampler::rl, 1, 4);
  const LearningSchedule schedule(settings, 1U << 20);
  Trial trial = trial_of_table(settings);
  FrameCounters counters;
  for (const std::uint32_t frame : {16U, 18U, 20U, 22U, 24U, 26U, 28U, 30U, 31U, 32U}) {
    counters.rays = frame == 32 ? 20 : 10;
    trial.look({.frame = frame, .width = 16, .sums = sums_after((frame - 16) / 2), .counters = counters});
  }
  ASSERT_TRUE(trial.gave_up());
  const std::uint32_t sequence = sequence_place(33, settings, schedule, trial).sequence;
  for (const std::uint32_t frame : {40U, 65U, 100U, 1000U}) {
    const SequencePlace place = sequence_place(frame, settings, schedule, trial);
    EXPECT_EQ(place.sequence, sequence);
    EXPECT_EQ(place.index, frame - 33);
  }
  EXPECT_NE(sequence_place(32, settings, schedule, trial).sequence, sequence);
}

TEST(SampleSequence, WeighsFramesOfShortStretchesLess) {
  const RenderSettings settings = sobol(Sampler::rl);
  const Trial none = trial_of_table(settings);
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
    EXPECT_FLOAT_EQ(frame_weight(frame, settings, none), static_cast<float>(weight)) << frame;
  }
  EXPECT_EQ(frame_weight(1, sobol(Sampler::bsdf), none), 1);
  RenderSettings independent = settings;
  independent.random = RandomNumbers::independent;
  EXPECT_EQ(frame_weight(1, independent, none), 1);
}

}  // namespace
}  // namespace qtrace
