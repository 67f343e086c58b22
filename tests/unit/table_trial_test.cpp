// The trial that decides whether the table is used, on images whose variances are known.
#include "engine/tracer/table_trial.h"

#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace qtrace::test {
namespace {

constexpr int kSize = 32;

// Sums of frames drawn one by one, as a film has them.
class Frames {
 public:
  void add(double mean, double deviation) {
    ++count_;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      const double x = mean + deviation * normal_(random_);
      sum_[i] += x;
      squares_[i] += x * x;
    }
  }

  RadianceImage image() const {
    RadianceImage image{kSize, kSize, static_cast<std::uint64_t>(count_), {}, {}};
    const double n = count_;
    for (std::size_t i = 0; i < sum_.size(); ++i) {
      image.mean.emplace_back(sum_[i] / n);
      image.variance.emplace_back((squares_[i] - sum_[i] * sum_[i] / n) / (n - 1) / n);
    }
    return image;
  }

 private:
  int count_ = 0;
  std::vector<double> sum_ = std::vector<double>(kSize * kSize), squares_ = sum_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

RenderSettings learned(int trial_frames) {
  RenderSettings settings;
  settings.sampler = Sampler::rl;
  settings.rl.trial_frames = trial_frames;
  return settings;
}

struct Means {
  double without, with;
};

// After frames of both kinds with these deviations: the first 16 with another one, which must not matter.
TableTrial tried(Means means, Means deviations) {
  TableTrial trial(learned(8));
  Frames odd, even;
  for (std::uint32_t frame = 1; frame <= 32; ++frame) {
    const bool without = trial.is_without(frame);
    Frames& half = frame % 2 == 1 ? odd : even;
    half.add(without ? means.without : means.with, frame <= 16 ? 5
                                                   : without   ? deviations.without
                                                               : deviations.with);
    if (trial.looks_after(frame)) trial.look({odd.image(), even.image()});
  }
  return trial;
}

TEST(TableTrial, LeavesTheTableOutOfEveryOtherFrameAfterTheFirst16) {
  const TableTrial trial(learned(2));
  for (std::uint32_t frame = 1; frame < 100; ++frame) {
    EXPECT_EQ(trial.is_without(frame), frame == 17 || frame == 19) << frame;
    EXPECT_EQ(trial.looks_after(frame), frame == 16 || frame == 20) << frame;
  }
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

// The sums of 1024 pixels' variances with 7 degrees of freedom each are known to 2 %.
TEST(TableTrial, FindsTheRatioOfVariancesAndDecidesByIt) {
  const TableTrial better = tried({1, 1}, {0.3, 0.2});
  ASSERT_TRUE(better.gain());
  EXPECT_NEAR(*better.gain(), 2.25, 0.2);
  EXPECT_FALSE(better.gave_up());
  EXPECT_FALSE(better.is_without(33));
  const TableTrial equal = tried({1, 1}, {0.2, 0.2});
  EXPECT_NEAR(*equal.gain(), 1, 0.1);
  EXPECT_TRUE(equal.gave_up());
  EXPECT_TRUE(equal.is_without(33));
  EXPECT_TRUE(equal.is_without(34));
}

TEST(TableTrial, SaysNothingWhereLightIsMissedWithoutTheTable) {
  const TableTrial trial = tried({0.5, 1}, {0.1, 0.4});
  EXPECT_TRUE(std::isinf(*trial.gain()));
  EXPECT_FALSE(trial.gave_up());
}

TEST(TableTrial, GoesOnFromWhatWasSaved) {
  Frames half;
  half.add(1, 0.2);
  half.add(1, 0.2);
  TableTrial within(learned(2));
  within.look({half.image(), half.image()});
  TableTrial after(learned(2));
  after.restore(within.saved());
  half.add(1, 0.2);
  half.add(1, 0.2);
  within.look({half.image(), half.image()});
  after.look({half.image(), half.image()});
  ASSERT_TRUE(after.gain() && within.gain());
  EXPECT_EQ(*after.gain(), *within.gain());
  TableTrial later(learned(2));
  later.restore(after.saved());
  EXPECT_EQ(later.gain(), after.gain());
  EXPECT_THROW(later.restore(std::vector<std::byte>(9)), Error);
}

}  // namespace
}  // namespace qtrace::test
