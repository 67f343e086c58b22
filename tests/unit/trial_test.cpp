// The trial that decides whether the table is used, on images whose errors are known.
#include "engine/tracer/trial.h"

#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kSize = 128;
constexpr std::size_t kPixels = kSize * kSize;

RenderSettings learned(int trial_frames, RandomNumbers random = RandomNumbers::independent) {
  RenderSettings settings;
  settings.sampler = Sampler::rl;
  settings.random = random;
  settings.rl.trial_frames = trial_frames;
  return settings;
}

// What frames of a kind draw: a pixel's value in one frame, which is point `index` of sequence `sequence`.
// Each pixel has two sequences.
using Draw = std::function<double(std::mt19937& random, std::size_t sequence, std::uint32_t index)>;

struct Kinds {
  Draw without, with;
  double work = 1.3;  // of a frame with the table
};

Draw normal(double mean, double deviation) {
  return [=](std::mt19937& random, std::size_t, std::uint32_t) {
    return std::normal_distribution<double>(mean, deviation)(random);
  };
}

// Light that one sample in `often` finds, for the mean 1.
Draw rare(double often) {
  return [=](std::mt19937& random, std::size_t, std::uint32_t) {
    return random() % static_cast<unsigned>(often) == 0 ? often : 0;
  };
}

// Points whose mean of two has the standard error deviation / sqrt(2), and whose mean of four has 2^-0.75 of
// that: the squared error falls as N^-1.5.
Draw steep(double mean, double deviation) {
  return [=, last = std::vector<double>(2 * kPixels), of_two = std::vector<double>(2 * kPixels)](
             std::mt19937& random, std::size_t sequence, std::uint32_t index) mutable {
    std::normal_distribution<double> draw(0, deviation);
    double value = 0;
    switch (index % 4) {
      case 1:
        of_two[sequence] = std::sqrt(2) * draw(random);
        value = of_two[sequence] - last[sequence];
        break;
      case 3:
        value = 2 * std::exp2(-0.25) * draw(random) - of_two[sequence] - last[sequence];
        break;
      default:
        value = last[sequence] = draw(random);
    }
    return mean + value;
  };
}

// A tracer that shows the trial its pilot and its frames.
class Frames {
 public:
  explicit Frames(Trial& trial) : trial_(trial) {
    for (auto& half : sums_) half.assign(kPixels, glm::vec3(0));
  }

  // Goes on from another's frames.
  Frames(Trial& trial, const Frames& other)
      : trial_(trial), sums_(other.sums_), random_(other.random_), frame_(other.frame_) {}

  void render_pilot(const Kinds& kinds) {
    HalfSums sums = sums_;
    for (std::uint32_t f = trial_.pilot_lessons() + 1; f <= trial_.pilot_frames() && !trial_.is_decided();
         ++f) {
      const std::size_t kind = trial_.pilot_is_without(f) ? 0 : 1;
      add(sums[kind], kind == 0 ? kinds.without : kinds.with, f - trial_.pilot_lessons(), 1);
      of_pilot_ = f;
      if (trial_.looks_after_pilot(f))
        trial_.look_at_pilot({f, kSize, sums, {counters(kinds, true), counters(kinds, false)}});
    }
  }

  void render(const Kinds& kinds, std::uint32_t frames, double weight = 1) {
    for (std::uint32_t i = 0; i < frames; ++i) {
      if (frame_ == 0) render_pilot(kinds);
      ++frame_;
      const bool without = trial_.is_without(frame_);
      const double own = weight * trial_.weight(frame_);
      add(sums_[(frame_ + 1) % 2], without ? kinds.without : kinds.with, frame_, own);
      if (trial_.looks_after(frame_))
        trial_.look(
            {frame_, {weight * trial_.weight(frame_ - 1), own}, kSize, sums_, counters(kinds, without)});
    }
  }

  std::uint32_t of_pilot() const { return of_pilot_; }

 private:
  // Frame `frame` of those that are tried, from 1, or of the image; the image's rounds start after whole
  // fours.
  void add(std::vector<glm::vec3>& sums, const Draw& draw, std::uint32_t frame, double weight) {
    const std::uint32_t pair = (frame - 1) / 2;
    for (std::size_t p = 0; p < kPixels; ++p)
      sums[p] += glm::vec3(static_cast<float>(weight * draw(random_, p + pair % 2 * kPixels, pair / 2)));
  }

  static FrameCounters counters(const Kinds& kinds, bool without) {
    FrameCounters counters;
    counters.rays = without ? 1000 : static_cast<std::uint64_t>(1000 * kinds.work);
    return counters;
  }

  Trial& trial_;
  HalfSums sums_;
  std::mt19937 random_{7};
  std::uint32_t frame_ = 0;
  std::uint32_t of_pilot_ = 0;
};

Trial tried(const Kinds& kinds, std::uint32_t frames = 80,
            RandomNumbers random = RandomNumbers::independent) {
  Trial trial = trial_of_table(learned(4, random));
  Frames(trial).render(kinds, frames);
  return trial;
}

// Kinds whose errors the pilot sees as `first` says, and all later frames as `later` does.
Trial tried_anew(const Kinds& first, const Kinds& later, std::uint32_t frames = 80) {
  Trial trial = trial_of_table(learned(4));
  Frames all(trial);
  all.render(first, 1);
  all.render(later, frames - 1);
  return trial;
}

const Kinds kEqual{normal(1, std::sqrt(1.3) * 0.2), normal(1, 0.2)};  // but for the work

TEST(TableTrial, LeavesTheTableOutOfEveryOtherFrameOfItsRounds) {
  const Trial trial = trial_of_table(learned(4));
  EXPECT_EQ(trial.pilot_lessons(), 8U);
  EXPECT_EQ(trial.pilot_frames(), 24U);
  for (std::uint32_t frame = 1; frame <= 24; ++frame)
    EXPECT_EQ(trial.pilot_is_without(frame), frame > 8 && frame % 2 == 1) << frame;
  for (std::uint32_t frame = 1; frame < 200; ++frame) {
    const bool is_tried = (frame > 16 && frame <= 32) || (frame > 64 && frame <= 80);
    EXPECT_EQ(trial.is_tried(frame), is_tried) << frame;
    EXPECT_EQ(trial.is_without(frame), is_tried && frame % 2 == 1) << frame;
  }
  EXPECT_EQ(trial.last_boundary(15), 0U);
  EXPECT_EQ(trial.last_boundary(23), 16U);
  EXPECT_EQ(trial.last_boundary(31), 16U);
  EXPECT_EQ(trial.last_boundary(32), 32U);
  EXPECT_EQ(trial.last_boundary(64), 64U);
  EXPECT_EQ(trial.last_boundary(1000), 80U);
}

TEST(TableTrial, IsNotWantedWithoutLearnedDirectionsOrWithLearnedLights) {
  EXPECT_TRUE(trial_of_table(learned(4)).is_wanted());
  EXPECT_FALSE(trial_of_table(learned(0)).is_wanted());
  RenderSettings settings = learned(4);
  settings.sampler = Sampler::bsdf;
  EXPECT_FALSE(trial_of_table(settings).is_wanted());
  settings = learned(4);
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  EXPECT_FALSE(trial_of_table(settings).is_wanted());
}

// Of a gain, from three channels of 16384 pixels with so many degrees of freedom each; all channels are alike
// here.
double error_of(double gain, double degrees) { return gain * 2 / std::sqrt(degrees * kPixels); }

// Half-way through the pilot there are four frames of either kind.
TEST(TableTrial, KeepsATableWhoseErrorTimesWorkIsLess) {
  const Trial trial = tried({normal(1, 0.3), normal(1, 0.2)}, 1);
  ASSERT_TRUE(trial.finding());
  EXPECT_EQ(trial.finding()->frame, 0U);
  EXPECT_NEAR(trial.finding()->gain, 2.25, 0.05);
  EXPECT_NEAR(trial.finding()->gain_error, error_of(2.25, 3), 0.005);
  EXPECT_NEAR(trial.finding()->work, 1.3, 1e-9);
  EXPECT_NEAR(trial.finding()->needed, 1.3, 1e-9);
  EXPECT_TRUE(trial.is_decided());
  EXPECT_FALSE(trial.gave_up());
  EXPECT_FALSE(trial.is_without(1));
  EXPECT_FALSE(trial.is_tried(17)) << "a round takes place though it is decided";
}

TEST(TableTrial, GivesATableUpThatTakesMoreWorkThanItSaves) {
  const Trial trial = tried({normal(1, 0.2), normal(1, 0.2)}, 1);
  EXPECT_NEAR(trial.finding()->gain, 1, 0.05);
  EXPECT_EQ(trial.finding()->frame, 0U);
  EXPECT_TRUE(trial.gave_up());
  EXPECT_TRUE(trial.is_without(1));
  EXPECT_TRUE(trial.is_without(2));
}

// After a round there are eight frames of either kind.
TEST(TableTrial, DecidesInALaterRound) {
  const Trial kept = tried_anew(kEqual, {normal(1, 0.3), normal(1, 0.2)});
  EXPECT_EQ(kept.finding()->frame, 32U);
  EXPECT_NEAR(kept.finding()->gain, 2.25, 0.2);
  EXPECT_NEAR(kept.finding()->gain_error, error_of(2.25, 7), 0.002);
  EXPECT_FALSE(kept.gave_up());
  EXPECT_TRUE(kept.is_tried(31)) << "what has been is forgotten";
  EXPECT_FALSE(kept.is_tried(65));
  const Trial given_up = tried_anew(kEqual, {normal(1, 0.2), normal(1, 0.2)});
  EXPECT_EQ(given_up.finding()->frame, 32U);
  EXPECT_TRUE(given_up.gave_up());
  EXPECT_FALSE(given_up.is_without(32));
  EXPECT_TRUE(given_up.is_without(34));
}

TEST(TableTrial, LooksAgainWhereItCannotTell) {
  EXPECT_FALSE(tried(kEqual, 16).is_decided());
  EXPECT_TRUE(tried(kEqual, 80).is_decided());
}

// A table that shows its worth only later is not given up in the pilot.
TEST(TableTrial, LeavesAYoungTableSomeTime) {
  EXPECT_FALSE(tried({normal(1, std::sqrt(1.25) * 0.2), normal(1, 0.2)}, 1).is_decided());
}

TEST(TableTrial, IsDecidedByNoSingleSample) {
  for (const bool without : {false, true}) {
    const Draw calm = normal(1, 0.2);
    const Draw bright = [&, count = std::size_t{0}](std::mt19937& random, std::size_t,
                                                    std::uint32_t) mutable {
      return ++count == 40000 ? 1e6 : calm(random, 0, 0);
    };
    const Trial trial = without ? tried({bright, calm}, 1) : tried({calm, bright}, 1);
    EXPECT_NEAR(trial.finding()->gain, 1, 0.1);
    EXPECT_TRUE(trial.gave_up()) << "the bright sample has decided";
  }
}

// Frames without the table that miss most of the light are calm, and say nothing.
TEST(TableTrial, SaysNothingWhereLightIsMissedWithoutTheTable) {
  const Trial trial = tried({normal(0.5, 0.1), normal(1, 0.4)});
  EXPECT_LT(trial.finding()->gain, 1);
  EXPECT_NEAR(trial.finding()->found, 0.5, 0.05);
  EXPECT_EQ(trial.finding()->frame, 80U);
  EXPECT_FALSE(trial.gave_up());
}

// Behind a door that is ajar, nothing may have found the light so far.
TEST(TableTrial, SaysNothingWhereAllIsBlack) {
  const Trial trial = tried({normal(0, 0), normal(0, 0)});
  EXPECT_EQ(trial.finding()->frame, 80U);
  EXPECT_FALSE(trial.gave_up());
}

// Where single paths bring most of the light, neither the error nor its own error is known early.
TEST(TableTrial, WaitsWhereFewSamplesHaveMostOfTheError) {
  EXPECT_FALSE(tried({rare(20000), rare(20000)}, 16).is_decided());
}

// Given a steep curve, fewer frames lose more, and so do nets that start anew.
TEST(TableTrial, NeedsMoreGainWhereTheErrorFallsFasterThanOneOverN) {
  const Kinds kinds{steep(1, 0.3), steep(1, 0.2)};
  const Trial trial = tried(kinds, 1, RandomNumbers::sobol);
  EXPECT_NEAR(trial.finding()->gain, 2.25, 0.2);
  EXPECT_NEAR(trial.finding()->needed, std::pow(1.3, 1.5) / (std::sqrt(2) - 1), 0.3);
  EXPECT_TRUE(trial.gave_up());
  const Trial flat = tried({normal(1, 0.3), normal(1, 0.2)}, 1, RandomNumbers::sobol);
  EXPECT_NEAR(flat.finding()->needed, 1.3, 0.1);
  EXPECT_FALSE(flat.gave_up());
}

// Two sequences have one degree of freedom.
TEST(TableTrial, TellsErrorsOfPointsByTheirTwoSequences) {
  const Trial trial = tried({normal(1, 0.3), normal(1, 0.2)}, 1, RandomNumbers::sobol);
  EXPECT_NEAR(trial.finding()->gain, 2.25, 0.2);
  EXPECT_NEAR(trial.finding()->gain_error, error_of(2.25, 1), 0.01);
}

// A clear case ends the pilot half-way, but a table is kept only when it is known how steep the curve is.
TEST(TableTrial, EndsItsPilotHalfWayWhereThatSuffices) {
  const auto seen = [](double without, RandomNumbers random) {
    Trial trial = trial_of_table(learned(4, random));
    Frames frames(trial);
    frames.render({normal(1, without), normal(1, 0.2)}, 1);
    EXPECT_TRUE(trial.is_decided());
    return frames.of_pilot();
  };
  EXPECT_EQ(seen(0.2, RandomNumbers::independent), 16U);
  EXPECT_EQ(seen(0.2, RandomNumbers::sobol), 16U);
  EXPECT_EQ(seen(0.3, RandomNumbers::independent), 16U);
  EXPECT_EQ(seen(0.3, RandomNumbers::sobol), 24U);
}

// With too few frames for two looks there is one.
TEST(TableTrial, IsAsShortAsItIsTold) {
  Trial trial = trial_of_table(learned(2));
  Frames frames(trial);
  frames.render({normal(1, 0.2), normal(1, 0.2)}, 1);
  EXPECT_TRUE(trial.gave_up());
  EXPECT_EQ(frames.of_pilot(), 12U);
}

// The pilot says how much noisier frames without the table are, and has no part in the image.
TEST(TableTrial, WeighsFramesWithoutTheTableByWhatThePilotFoundThemWorth) {
  Trial trial = trial_of_table(learned(4));
  Frames frames(trial);
  EXPECT_EQ(trial.weight(17), 1);
  frames.render({normal(1, std::sqrt(1.55) * 0.2), normal(1, 0.2), 1.6}, 17);
  ASSERT_FALSE(trial.is_decided());
  const double gain = trial.finding()->gain;
  ASSERT_GT(gain, 1.5);
  EXPECT_DOUBLE_EQ(trial.weight(17), 1 / gain);
  EXPECT_EQ(trial.weight(16), 1);
  EXPECT_EQ(trial.weight(18), 1);
  EXPECT_DOUBLE_EQ(trial.weight(31), 1 / gain);
  EXPECT_EQ(trial.weight(33), 1);
  ASSERT_TRUE(trial.is_tried(65));
  EXPECT_EQ(trial.weight(65), 1) << "whether there is a second round depends on the image's samples";
  frames.render({normal(1, 0.2), normal(1, 0.2)}, 20);
  ASSERT_TRUE(trial.gave_up());
  EXPECT_DOUBLE_EQ(trial.weight(31), 1 / gain) << "what has been is forgotten";
  EXPECT_EQ(trial.weight(35), 1);
}

TEST(TableTrial, KnowsWhatFramesWeigh) {
  std::array<Trial, 2> trials{trial_of_table(learned(4)), trial_of_table(learned(4))};
  for (std::size_t i = 0; i < 2; ++i) {
    Frames frames(trials[i]);
    frames.render(kEqual, 32, i == 0 ? 0.5 : 2);
  }
  ASSERT_EQ(trials[0].finding()->frame, trials[1].finding()->frame);
  EXPECT_NEAR(trials[0].finding()->gain, trials[1].finding()->gain, 1e-3);
}

TEST(TableTrial, GoesOnFromWhatWasSaved) {
  const Kinds kinds{normal(1, 0.24), normal(1, 0.21)};
  for (const std::uint32_t frames : {3U, 17U, 21U, 25U, 30U, 31U, 32U}) {
    Trial whole = trial_of_table(learned(4));
    Frames first(whole);
    first.render(kinds, frames);
    Trial later = trial_of_table(learned(4));
    later.restore(whole.saved());
    Frames second(later, first);
    first.render(kinds, 40 - frames);
    second.render(kinds, 40 - frames);
    ASSERT_TRUE(later.finding() && whole.finding()) << frames;
    EXPECT_EQ(later.finding()->frame, 32U) << frames;
    EXPECT_EQ(later.finding()->gain, whole.finding()->gain) << frames;
    EXPECT_EQ(later.finding()->work, whole.finding()->work) << frames;
    EXPECT_EQ(later.is_decided(), whole.is_decided()) << frames;
  }
  Trial trial = trial_of_table(learned(4));
  EXPECT_THROW(trial.restore(std::vector<std::byte>(9)), Error);
}

RenderSettings with_light_paths(int frames, RandomNumbers random = RandomNumbers::independent) {
  RenderSettings settings;
  settings.sampler = Sampler::bsdf;
  settings.random = random;
  settings.light_paths = LightPaths::trace;
  settings.light_path_trial = frames;
  return settings;
}

Trial tried_light_paths(const Kinds& kinds, RandomNumbers random = RandomNumbers::independent) {
  Trial trial = trial_of_light_paths(with_light_paths(4, random));
  Frames(trial).render(kinds, 100);
  return trial;
}

TEST(LightPathTrial, IsWantedWhereThereAreSuchPaths) {
  EXPECT_TRUE(trial_of_light_paths(with_light_paths(4)).is_wanted());
  EXPECT_FALSE(trial_of_light_paths(with_light_paths(0)).is_wanted());
  EXPECT_FALSE(trial_of_light_paths(learned(4)).is_wanted());
}

TEST(LightPathTrial, HasAPilotWithoutLessonsAndNoRounds) {
  const Trial trial = trial_of_light_paths(with_light_paths(4));
  EXPECT_EQ(trial.pilot_lessons(), 0U);
  EXPECT_EQ(trial.pilot_frames(), 16U);
  for (std::uint32_t frame = 1; frame < 200; ++frame) {
    EXPECT_FALSE(trial.is_tried(frame)) << frame;
    EXPECT_FALSE(trial.looks_after(frame)) << frame;
  }
}

TEST(LightPathTrial, GoesByErrorTimesWork) {
  EXPECT_FALSE(tried_light_paths({normal(1, 0.4), normal(1, 0.2), 2.4}).gave_up());
  const Trial given_up = tried_light_paths({normal(1, 0.25), normal(1, 0.2), 2.4});
  EXPECT_TRUE(given_up.gave_up());
  EXPECT_TRUE(given_up.is_without(1));
}

// A gain so close to the work that two standard errors do not tell them apart.
TEST(LightPathTrial, IsDecidedByTheEndOfItsPilot) {
  for (const double work : {2.2, 2.25, 2.3}) {
    const Trial trial = tried_light_paths({normal(1, 0.3), normal(1, 0.2), work});
    EXPECT_TRUE(trial.is_decided());
    EXPECT_EQ(trial.gave_up(), trial.finding()->gain < work);
  }
}

TEST(LightPathTrial, KeepsWhatFindsLightThatTheOthersMiss) {
  EXPECT_FALSE(tried_light_paths({normal(0.5, 0.1), normal(1, 0.3), 2.4}).gave_up());
}

// Work of frames with light paths is needed as often as with the table, but nothing cuts sequences short.
TEST(LightPathTrial, NeedsWhatTheCurveOfSobolPointsAsksFor) {
  const Trial trial = tried_light_paths({steep(1, 0.4), steep(1, 0.2), 2}, RandomNumbers::sobol);
  EXPECT_NEAR(trial.finding()->needed, std::pow(2, 1.5), 0.3);
}

}  // namespace
}  // namespace qtrace::test
