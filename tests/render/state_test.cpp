// Halves of the samples, and states: a tracer that restores one goes on with the bits of one that never
// stopped.
#include "engine/core/check.h"
#include "tests/render/comparison.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

RenderSettings small_settings(Sampler sampler, LightChoice lights) {
  RenderSettings settings = base_settings(5);
  settings.width = settings.height = 24;
  settings.max_bounces = 4;
  settings.sampler = sampler;
  settings.nee = Nee::one_ray;
  settings.lights = lights;
  settings.rl.sites_per_object = 8;
  return settings;
}

void expect_equal(const RadianceImage& a, const RadianceImage& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.variance, b.variance);
}

// A tracer of all frames, and one that goes on from its state after the first ones.
struct Pair {
  Tracer whole, later;
};

// Expects the same image of both.
Pair expect_going_on(const Scene& scene, const RenderSettings& settings, int first, int more) {
  Pair pair{Tracer(device(), scene, settings), Tracer(device(), scene, settings)};
  render(pair.whole, first);
  pair.later.restore(pair.whole.state());
  render(pair.whole, more);
  render(pair.later, more);
  expect_equal(pair.later.radiance(), pair.whole.radiance());
  return pair;
}

// What waits for the next update is part of the state.
TEST(State, HoldsWhatTheTableHasNotYetLearned) {
  const Scene scene = glossy_room();
  RenderSettings settings = small_settings(Sampler::rl, LightChoice::learned);
  settings.rl.mixture = Mixture::learned;
  settings.rl.update_growth = 1;  // after frames 1, 2, 4, 8
  Pair pair = expect_going_on(scene, settings, 6, 4);
  EXPECT_EQ(pair.later.table()->values(), pair.whole.table()->values());
}

// What light paths bring in a frame is in the sums when the frame ends.
TEST(State, GoesOnWithLightPaths) {
  const Scene scene = glossy_room();
  RenderSettings settings = small_settings(Sampler::rl, LightChoice::power);
  settings.light_paths = LightPaths::connect;
  settings.rl.trial_frames = 0;
  for (const int trial_frames : {0, 4}) {
    settings.light_path_trial = trial_frames;
    const Pair pair = expect_going_on(scene, settings, 3, 3);
    EXPECT_EQ(pair.later.light_path_trial().gave_up(), pair.whole.light_path_trial().gave_up());
  }
}

// Before the trial of the table, within it and after it.
TEST(State, GoesOnThroughATrialOfTheTable) {
  const Scene scene = glossy_room();
  RenderSettings settings = small_settings(Sampler::rl, LightChoice::power);
  settings.rl.trial_frames = 4;
  Tracer whole(device(), scene, settings);
  std::vector<Tracer> states;
  for (const int frames : {3, 14, 3, 5, 7}) {
    render(whole, frames);
    Tracer later(device(), scene, settings);
    later.restore(whole.state());
    states.push_back(std::move(later));
  }
  render(whole, 20);
  ASSERT_TRUE(whole.table_trial().finding());
  for (Tracer& later : states) {
    render(later, static_cast<int>(whole.frames() - later.frames()));
    expect_equal(later.radiance(), whole.radiance());
    ASSERT_TRUE(later.table_trial().finding());
    EXPECT_EQ(later.table_trial().finding()->gain, whole.table_trial().finding()->gain);
    EXPECT_EQ(later.table_trial().is_decided(), whole.table_trial().is_decided());
  }
}

class States : public testing::TestWithParam<std::pair<Sampler, LightChoice>> {
 protected:
  RenderSettings settings() const { return small_settings(GetParam().first, GetParam().second); }
};

TEST_P(States, GoOnWithTheSameBits) {
  const Scene scene = glossy_room();
  const std::vector<float> thresholds(24 * 24, 1.0F);
  Tracer whole(device(), scene, settings());
  whole.set_firefly_thresholds(thresholds);
  render(whole, 3);
  const TracerState state = whole.state();
  render(whole, 4);

  Tracer later(device(), scene, settings());
  render(later, 2);  // forgotten
  later.restore(state);
  EXPECT_EQ(later.frames(), 3U);
  render(later, 4);
  expect_equal(later.radiance(), whole.radiance());
  for (std::size_t half = 0; half < 2; ++half) expect_equal(later.halves()[half], whole.halves()[half]);
  EXPECT_GT(whole.outliers().firefly_sum, 0);
  EXPECT_EQ(later.outliers().firefly_sum, whole.outliers().firefly_sum);
  EXPECT_EQ(later.last_frame_counters().rays, whole.last_frame_counters().rays);
  ASSERT_EQ(later.table() == nullptr, whole.table() == nullptr);
  if (whole.table() == nullptr) return;
  EXPECT_EQ(later.table()->values(), whole.table()->values());
  EXPECT_EQ(later.table()->visits(), whole.table()->visits());
}

INSTANTIATE_TEST_SUITE_P(Samplers, States,
                         testing::Values(std::pair(Sampler::bsdf, LightChoice::power),
                                         std::pair(Sampler::bsdf, LightChoice::learned),
                                         std::pair(Sampler::rl, LightChoice::power)));

TEST(State, OfAnotherTracerIsRefusedAndChangesNothing) {
  const Scene scene = glossy_room();
  RenderSettings settings = small_settings(Sampler::bsdf, LightChoice::power);
  Tracer tracer(device(), scene, settings);
  render(tracer, 2);
  const RadianceImage before = tracer.radiance();
  settings.width = 16;
  EXPECT_THROW(tracer.restore(Tracer(device(), scene, settings).state()), Error);
  settings = small_settings(Sampler::rl, LightChoice::power);
  EXPECT_THROW(tracer.restore(Tracer(device(), scene, settings).state()), Error);
  expect_equal(tracer.radiance(), before);
}

// Frame by frame, from tracers that render no more.
TEST(Halves, AreTheMeansOfOddAndOfEvenFrames) {
  const Scene scene = glossy_room();
  const RenderSettings settings = small_settings(Sampler::bsdf, LightChoice::power);
  constexpr int kFrames = 5;
  Tracer tracer(device(), scene, settings);
  std::vector<glm::dvec3> sums[2], before(24 * 24, glm::dvec3(0));
  sums[0] = sums[1] = before;
  for (int frame = 1; frame <= kFrames; ++frame) {
    tracer.render_frame();
    const RadianceImage image = tracer.radiance();
    for (std::size_t i = 0; i < before.size(); ++i) {
      const glm::dvec3 now = image.mean[i] * static_cast<double>(frame);
      sums[(frame + 1) % 2][i] += now - before[i];
      before[i] = now;
    }
  }
  const auto halves = tracer.halves();
  EXPECT_EQ(halves[0].samples, 3U);
  EXPECT_EQ(halves[1].samples, 2U);
  for (std::size_t half = 0; half < 2; ++half) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      const glm::dvec3 expected = sums[half][i] / static_cast<double>(halves[half].samples);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(halves[half].mean[i][c], expected[c], 1e-9);
    }
  }
}

}  // namespace
}  // namespace qtrace::test
