// Warm-up and noise, in series that are made up.
#include "experiments/records/frame_times.h"

#include <gtest/gtest.h>

namespace qtrace::experiments {
namespace {

// Twenty frames of 100 with two per cent of ripple.
std::vector<double> steady() {
  std::vector<double> times;
  for (int i = 0; i < 20; ++i) times.push_back(100 + i % 3 - 1);
  return times;
}

RunRecord record_of(const std::vector<double>& times) {
  RunRecord record;
  record.run.id = "a-run";
  record.run.config.warmup_frames = 1;
  for (std::size_t i = 0; i < times.size(); ++i) {
    FrameRecord frame;
    frame.is_warmup = i == 0;
    frame.host_ms = times[i];
    frame.counters.rays = 1'000'000;
    record.frames.push_back(frame);
  }
  return record;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(FrameTimes, SlowFirstFramesAreCounted) {
  std::vector<double> times = steady();
  EXPECT_EQ(slow_first_frames(times), 0);
  times[0] = 300;
  times[1] = 200;
  times[2] = 120;
  EXPECT_EQ(slow_first_frames(times), 3);
  times[10] = 500;  // later ones are noise
  EXPECT_EQ(slow_first_frames(times), 3);
  for (std::size_t i = 0; i < 9; ++i) times[i] = 300;  // nearly half of them: no warm-up
  EXPECT_EQ(slow_first_frames(times), 0);
  EXPECT_FALSE(slow_first_frames({3, 2, 1, 1, 1}).has_value());
}

TEST(FrameTimes, NoiseIsSpreadOrManyOutliers) {
  std::vector<double> times = steady();
  EXPECT_EQ(is_noisy(times), false);
  times[5] = times[6] = 150;  // a tenth of the frames
  EXPECT_EQ(is_noisy(times), false);
  times[7] = 150;
  EXPECT_EQ(is_noisy(times), true);
  times = steady();
  for (std::size_t i = 0; i < times.size(); i += 2) times[i] *= 1.15;
  EXPECT_EQ(is_noisy(times), true);
  EXPECT_FALSE(is_noisy({1, 9}).has_value());
}

TEST(FrameTimes, LongerPathsAreNoNoise) {
  RunRecord record = record_of(steady());
  for (std::size_t i = 0; i < record.frames.size(); ++i) {
    record.frames[i].counters.rays *= i + 1;
    record.frames[i].host_ms *= static_cast<double>(i + 1);
  }
  EXPECT_EQ(is_noisy(settled_times(record)), false);
  EXPECT_EQ(slow_first_frames(times_per_ray(record)), 0);
  EXPECT_EQ(time_warnings({record}), "");
}

// 16 frames that teach, then every fourth, and a trial that leaves the table out.
RunRecord learning_record() {
  RunRecord record = record_of(std::vector<double>(48));
  for (std::size_t i = 0; i < record.frames.size(); ++i) {
    const bool teaches = i < 16 || i % 4 == 0;
    const bool asks = i < 16 || i > 23 || i % 2 == 0;
    FrameRecord& frame = record.frames[i];
    frame.counters.table_updates = teaches && asks ? 1000 : 0;
    frame.counters.cell_lookups = asks ? 1000 : 0;
    frame.host_ms = (asks ? teaches ? 150 : 110 : 80) + static_cast<double>(i % 3) - 1;
  }
  return record;
}

TEST(FrameTimes, TeachingIsNeitherNoiseNorWarmup) {
  RunRecord record = learning_record();
  EXPECT_EQ(is_noisy(settled_times(record)), false);
  EXPECT_EQ(slow_first_frames(times_per_ray(record)), 0);
  record.frames[0].host_ms = record.frames[1].host_ms = 400;
  EXPECT_EQ(slow_first_frames(times_per_ray(record)), 2);
  for (std::size_t i = 0; i < record.frames.size(); i += 5) record.frames[i].host_ms *= 1.5;
  EXPECT_EQ(is_noisy(settled_times(record)), true);
}

TEST(FrameTimes, OneWarningForAllRunsSaysWhatToDo) {
  std::vector<double> late = steady(), noisy = steady();
  late[0] = late[1] = late[2] = 300;
  for (std::size_t i = 0; i < noisy.size(); i += 2) noisy[i] *= 1.3;
  const std::string text =
      time_warnings({record_of(steady()), record_of(late), record_of(late), record_of(noisy)});
  EXPECT_TRUE(contains(text, "2 runs had more slow frames")) << text;
  EXPECT_TRUE(contains(text, "raise warmup_frames to 3")) << text;
  EXPECT_TRUE(contains(text, "noisy in 1 of 4 runs")) << text;
  std::vector<double> first = steady();
  first[0] = 300;  // warmup_frames leaves it out
  EXPECT_EQ(time_warnings({record_of(first)}), "");
}

}  // namespace
}  // namespace qtrace::experiments
