// When a table learns, against sequences worked out by hand.
#include "engine/tracer/learning_schedule.h"

#include "engine/tracer/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace qtrace {
namespace {

constexpr std::uint32_t kRoomForAll = 1U << 29;

LearningSchedule schedule(int teach_frames, double update_growth) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.rl.teach_frames = teach_frames;
  settings.rl.update_growth = update_growth;
  return {settings, kRoomForAll};
}

LearningSchedule doubling(int teach_frames, std::uint32_t most_taught) {
  RenderSettings settings;
  settings.random = RandomNumbers::sobol;
  settings.rl.teach_frames = teach_frames;
  return {settings, most_taught};
}

std::vector<std::uint32_t> updates_of(const LearningSchedule& schedule, std::uint32_t first,
                                      std::uint32_t last) {
  std::vector<std::uint32_t> updates;
  for (std::uint32_t frame = first; frame <= last; ++frame) {
    if (schedule.updates(frame)) updates.push_back(frame);
  }
  return updates;
}

TEST(LearningSchedule, OfThePaperTeachesAndUpdatesEveryFrame) {
  const LearningSchedule all = schedule(0, 0);
  for (std::uint32_t frame = 1; frame <= 1000; ++frame) {
    EXPECT_TRUE(all.teaches(frame));
    EXPECT_TRUE(all.updates(frame));
  }
}

// After the first n frames the share is n / frame, so that n (1 + ln(N / n)) of N frames have taught.
TEST(LearningSchedule, TeachesEverMoreRarely) {
  const LearningSchedule thinned = schedule(16, 0);
  int taught = 0;
  int last = 0;
  int longest = 0;
  for (int frame = 1; frame <= 4096; ++frame) {
    if (!thinned.teaches(static_cast<std::uint32_t>(frame))) continue;
    ++taught;
    longest = std::max(longest, frame - last);
    last = frame;
  }
  EXPECT_NEAR(taught, 16 * (1 + std::log(256.0)), 1);
  EXPECT_LE(longest, 4096 / 16 + 1);
  for (std::uint32_t frame = 1; frame <= 16; ++frame) EXPECT_TRUE(thinned.teaches(frame));
}

// With a quarter: after 4 it waits 1, after 8 it waits 2, after 12 it waits 3, ...
TEST(LearningSchedule, UpdatesWhenEnoughFramesHavePassed) {
  const LearningSchedule grown = schedule(0, 0.25);
  EXPECT_EQ(updates_of(grown, 1, 30),
            (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 18, 22, 27}));
}

TEST(LearningSchedule, NeverWaitsLongerThanASumCanHold) {
  const LearningSchedule grown = schedule(0, 1);
  std::uint32_t last = 0;
  for (std::uint32_t frame = 1; frame <= 5000; ++frame) {
    if (!grown.updates(frame)) continue;
    EXPECT_LE(frame - last, kMostFramesPerUpdate);
    last = frame;
  }
  EXPECT_GT(last, 5000 - kMostFramesPerUpdate);
}

// 2^29 targets are counted: 1920 x 1080 paths with six events each may teach one entry 43 times so often, and
// with 300 events not once.
TEST(LearningSchedule, WaitsShorterWhereAFrameTeachesMore) {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = 128;
  settings.max_bounces = 8;
  EXPECT_GT(most_taught_frames(settings), kMostFramesPerUpdate);
  settings.width = 1920;
  settings.height = 1080;
  settings.max_bounces = 5;
  EXPECT_EQ(most_taught_frames(settings), 43U);
  settings.max_bounces = 63;
  EXPECT_EQ(most_taught_frames(settings), 4U);
  settings.max_bounces = 300;
  EXPECT_EQ(most_taught_frames(settings), 0U);
  const std::vector<std::uint32_t> updates = updates_of(LearningSchedule(settings, 4), 100, 199);
  EXPECT_EQ(updates.size(), 25U);
  for (std::size_t i = 1; i < updates.size(); ++i) EXPECT_EQ(updates[i] - updates[i - 1], 4U);
}

TEST(LearningSchedule, DoublesWithSobolPoints) {
  EXPECT_EQ(updates_of(doubling(16, kRoomForAll), 0, 1000),
            (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32, 64, 128, 256, 512}));
}

// Stretches are shorter where a sum could not hold what they teach, and still powers of two. Of frames that
// teach ever more rarely, 11 fall on every doubling.
TEST(LearningSchedule, KeepsNetsWholeWhereASumHoldsLess) {
  EXPECT_EQ(updates_of(doubling(0, 10), 1, 40), (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 24, 32, 40}));
  EXPECT_EQ(updates_of(doubling(16, 12), 1, 600),
            (std::vector<std::uint32_t>{1, 2, 4, 8, 16, 32, 64, 128, 256, 512}));
}

TEST(LearningSchedule, KnowsTheLastUpdate) {
  for (const LearningSchedule& s :
       {schedule(16, 0.1), schedule(0, 0), doubling(16, kRoomForAll), doubling(0, 10)}) {
    std::uint32_t last = 0;
    for (std::uint32_t frame = 1; frame <= 300; ++frame) {
      if (s.updates(frame)) last = frame;
      EXPECT_EQ(s.last_update(frame), last);
    }
  }
}

}  // namespace
}  // namespace qtrace
