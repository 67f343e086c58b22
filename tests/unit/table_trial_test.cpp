// The trial that decides whether the table is used, on images whose errors are known.
#include "engine/tracer/table_trial.h"

#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kSize = 128;
constexpr std::size_t kPixels = kSize * kSize;

RenderSettings learned(int trial_frames) {
  RenderSettings settings;
  settings.sampler = Sampler::rl;
  settings.rl.trial_frames = trial_frames;
  return settings;
}

// What frames of both kinds draw: a pixel's value in one frame.
using Draw = std::function<double(std::mt19937& random, std::size_t pixel)>;

struct Kinds {
  Draw without, with;
  double work = 1.3;  // of a frame with the table
};

Draw normal(double mean, double deviation) {
  return [=](std::mt19937& random, std::size_t) {
    return std::normal_distribution<double>(mean, deviation)(random);
  };
}

// Light that one sample in `often` finds, for the mean 1.
Draw rare(double often) {
  return [=](std::mt19937& random, std::size_t) {
    return random() % static_cast<unsigned>(often) == 0 ? often : 0;
  };
}

// A tracer that shows the trial `frames` frames.
class Frames {
 public:
  explicit Frames(TableTrial& trial) : trial_(trial) {
    for (auto& half : sums_) half.assign(kPixels, glm::dvec3(0));
  }

  // Goes on from another's frames.
  Frames(TableTrial& trial, const Frames& other)
      : trial_(trial), sums_(other.sums_), random_(other.random_), frame_(other.frame_) {}

  void render(const Kinds& kinds, std::uint32_t frames, double weight = 1) {
    for (std::uint32_t i = 0; i < frames; ++i) {
      ++frame_;
      const bool without = trial_.is_without(frame_);
      for (std::size_t p = 0; p < kPixels; ++p)
        sums_[(frame_ + 1) % 2][p] += weight * glm::dvec3((without ? kinds.without : kinds.with)(random_, p));
      if (!trial_.looks_after(frame_)) continue;
      FrameCounters counters;
      counters.rays = without ? 1000 : static_cast<std::uint64_t>(1000 * kinds.work);
      trial_.look({frame_, weight, kSize, sums_, counters});
    }
  }

 private:
  TableTrial& trial_;
  HalfSums sums_;
  std::mt19937 random_{7};
  std::uint32_t frame_ = 0;
};

TableTrial tried(const Kinds& kinds, std::uint32_t frames = 128) {
  TableTrial trial(learned(4));
  Frames(trial).render(kinds, frames);
  return trial;
}

TEST(TableTrial, LeavesTheTableOutOfEveryOtherFrameOfItsRounds) {
  const TableTrial trial(learned(4));
  for (std::uint32_t frame = 1; frame < 200; ++frame) {
    const bool is_tried =
        (frame > 4 && frame <= 8) || (frame > 16 && frame <= 32) || (frame > 64 && frame <= 128);
    EXPECT_EQ(trial.is_tried(frame), is_tried) << frame;
    EXPECT_EQ(trial.is_without(frame), is_tried && frame % 2 == 1) << frame;
  }
  EXPECT_EQ(trial.last_boundary(3), 0U);
  EXPECT_EQ(trial.last_boundary(5), 4U);
  EXPECT_EQ(trial.last_boundary(7), 6U);
  EXPECT_EQ(trial.last_boundary(15), 8U);
  EXPECT_EQ(trial.last_boundary(30), 24U);
  EXPECT_EQ(trial.last_boundary(1000), 128U);
}

TEST(TableTrial, IsNotWantedWithoutLearnedDirectionsOrWithLearnedLights) {
  EXPECT_TRUE(TableTrial(learned(4)).is_wanted());
  EXPECT_FALSE(TableTrial(learned(0)).is_wanted());
  RenderSettings settings = learned(4);
  settings.sampler = Sampler::bsdf;
  EXPECT_FALSE(TableTrial(settings).is_wanted());
  settings = learned(4);
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  EXPECT_FALSE(TableTrial(settings).is_wanted());
}

// Three channels of 16384 pixels with one degree of freedom each; all channels are alike here.
TEST(TableTrial, KeepsATableWhoseErrorTimesWorkIsLess) {
  const TableTrial trial = tried({normal(1, 0.3), normal(1, 0.2)});
  ASSERT_TRUE(trial.finding());
  EXPECT_EQ(trial.finding()->frame, 8U);
  EXPECT_NEAR(trial.finding()->gain, 2.25, 0.2);
  EXPECT_NEAR(trial.finding()->gain_error, 2.25 * 2 / std::sqrt(kPixels), 0.01);
  EXPECT_NEAR(trial.finding()->work, 1.3, 1e-9);
  EXPECT_TRUE(trial.is_decided());
  EXPECT_FALSE(trial.gave_up());
  EXPECT_FALSE(trial.is_without(9));
  EXPECT_FALSE(trial.is_tried(17)) << "a later round takes place though it is decided";
  EXPECT_TRUE(trial.is_tried(7)) << "what has been is forgotten";
}

TEST(TableTrial, GivesATableUpThatTakesMoreWorkThanItSaves) {
  const TableTrial trial = tried({normal(1, 0.2), normal(1, 0.2)});
  EXPECT_NEAR(trial.finding()->gain, 1, 0.1);
  EXPECT_EQ(trial.finding()->frame, 8U);
  EXPECT_TRUE(trial.gave_up());
  EXPECT_TRUE(trial.is_without(9));
  EXPECT_TRUE(trial.is_without(10));
  EXPECT_FALSE(trial.is_without(6));
}

TEST(TableTrial, LooksAgainWhereItCannotTell) {
  const Kinds equal{normal(1, std::sqrt(1.3) * 0.2), normal(1, 0.2)};
  EXPECT_FALSE(tried(equal, 8).is_decided());
  EXPECT_TRUE(tried(equal, 128).is_decided());
}

// A table that shows its worth only later is not given up in the first round.
TEST(TableTrial, LeavesAYoungTableSomeTime) {
  const TableTrial trial = tried({normal(1, std::sqrt(1.25) * 0.2), normal(1, 0.2)}, 8);
  EXPECT_FALSE(trial.is_decided());
}

TEST(TableTrial, IsDecidedByNoSingleSample) {
  for (const bool without : {false, true}) {
    const Draw calm = normal(1, 0.2);
    const Draw bright = [&, count = std::size_t{0}](std::mt19937& random, std::size_t) mutable {
      return ++count == 40000 ? 1e6 : calm(random, 0);
    };
    const TableTrial trial = without ? tried({bright, calm}, 8) : tried({calm, bright}, 8);
    EXPECT_NEAR(trial.finding()->gain, 1, 0.1);
    EXPECT_TRUE(trial.gave_up()) << "the bright sample has decided";
  }
}

// Frames without the table that miss most of the light are calm, and say nothing.
TEST(TableTrial, SaysNothingWhereLightIsMissedWithoutTheTable) {
  const TableTrial trial = tried({normal(0.5, 0.1), normal(1, 0.4)});
  EXPECT_LT(trial.finding()->gain, 1);
  EXPECT_NEAR(trial.finding()->found, 0.5, 0.05);
  EXPECT_EQ(trial.finding()->frame, 128U);
  EXPECT_FALSE(trial.gave_up());
}

// Where single paths bring most of the light, neither the error nor its own error is known early.
TEST(TableTrial, WaitsWhereFewSamplesHaveMostOfTheError) {
  EXPECT_FALSE(tried({rare(20000), rare(20000)}, 8).is_decided());
}

TEST(TableTrial, KnowsWhatFramesWeigh) {
  TableTrial light(learned(4));
  TableTrial heavy(learned(4));
  Frames(light).render({normal(1, 0.3), normal(1, 0.2)}, 8, 0.5);
  Frames(heavy).render({normal(1, 0.3), normal(1, 0.2)}, 8, 2);
  EXPECT_NEAR(light.finding()->gain, heavy.finding()->gain, 1e-9);
}

TEST(TableTrial, GoesOnFromWhatWasSaved) {
  const Kinds kinds{normal(1, 0.3), normal(1, 0.25)};
  for (const std::uint32_t frames : {3U, 5U, 7U, 8U, 20U}) {
    TableTrial whole(learned(4));
    Frames first(whole);
    first.render(kinds, frames);
    TableTrial later(learned(4));
    later.restore(whole.saved());
    Frames second(later, first);
    first.render(kinds, 40 - frames);
    second.render(kinds, 40 - frames);
    ASSERT_TRUE(later.finding() && whole.finding()) << frames;
    EXPECT_EQ(later.finding()->gain, whole.finding()->gain) << frames;
    EXPECT_EQ(later.finding()->work, whole.finding()->work) << frames;
    EXPECT_EQ(later.is_decided(), whole.is_decided()) << frames;
  }
  TableTrial trial(learned(4));
  EXPECT_THROW(trial.restore(std::vector<std::byte>(9)), Error);
}

}  // namespace
}  // namespace qtrace::test
