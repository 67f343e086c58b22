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
  Frames expected{{1}, {2}, {3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12, 13, 14, 15, 16}};
  for (const std::uint32_t first : {17U, 18U, 25U, 26U})
    expected.push_back({first, first + 2, first + 4, first + 6});
  EXPECT_EQ(sequences(sobol(Sampler::rl, 1, 4), 32), expected);
}

// Lessons have sequences of their own, as the table is updated after each; then it stands still.
TEST(SampleSequence, OfThePilotIsThatOfALessonOrOfAKindInAHalf) {
  const TableTrial trial(sobol(Sampler::rl, 1, 4));
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
                              {9, 11, 13, 15},
                              {10, 12, 14, 16},
                              {17, 19, 21, 23},
                              {18, 20, 22, 24}}));
}

// Pixels of both kinds after each quarter of a round, whose first half is a tenth brighter than 1 and whose
// second half is as much darker: nothing is gained.
HalfSums sums_after(int quarter) {
  const float value = std::array{0.0F, 2.2F, 4.4F, 6.2F, 8.0F}[static_cast<std::size_t>(quarter)];
  const std::vector<glm::vec3> pixels(256, glm::vec3(value));
  return {pixels, pixels};
}

// Its table takes twice the work.
void give_up(TableTrial& trial) {
  TableTrial::PilotLook look;
  look.width = 16;
  for (int quarter = 1; quarter <= 4; ++quarter) look.sums.push_back(sums_after(quarter));
  look.counters[0].rays = 10;
  look.counters[1].rays = 20;
  trial.look_at_pilot(look);
}

// A table that was given up before the first frame leaves one sequence, and all frames alike.
TEST(SampleSequence, IsOneWithoutATableThatWasGivenUp) {
  const RenderSettings settings = sobol(Sampler::rl, 1, 4);
  const LearningSchedule schedule(settings, 1U << 20);
  TableTrial trial(settings);
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
  TableTrial trial(settings);
  FrameCounters counters;
  for (const std::uint32_t frame : {16U, 20U, 24U, 28U, 31U, 32U}) {
    counters.rays = frame == 32 ? 20 : 10;
    trial.look({frame, 1, 16, sums_after(static_cast<int>(frame - 16) / 4), counters});
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
  const TableTrial none(settings);
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
