// Where the table is given up, and where it is not.
#include "tests/support/render.h"

#include "engine/gltf/load_gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace qtrace::test {
namespace {

RenderSettings settings_of(Nee nee) {
  RenderSettings settings;
  settings.width = settings.height = 64;
  settings.sampler = Sampler::rl;
  settings.nee = nee;
  return settings;
}

Tracer rendered(const char* name, const RenderSettings& settings, int frames) {
  const Scene scene = load_gltf(std::string(QTRACE_SOURCE_DIR "/configs/scenes/") + name);
  Tracer tracer(device(), scene, settings);
  for (int i = 0; i < frames; ++i) tracer.render_frame();
  return tracer;
}

// Under an even sky there is nothing to learn. A run that gives the table up in its pilot is the one that
// never had a table, bit by bit, whatever its random numbers.
TEST(TableTrial, GivesTheTableUpUnderAnEvenSkyAndLeavesNoTrace) {
  for (const RandomNumbers random : {RandomNumbers::independent, RandomNumbers::sobol}) {
    RenderSettings settings = settings_of(Nee::none);
    settings.width = settings.height = 128;
    settings.environment = {1, 1, 1};
    settings.random = random;
    const Tracer tracer = rendered("open_sky.glb", settings, 3);
    ASSERT_TRUE(tracer.table_trial().finding());
    EXPECT_LT(tracer.table_trial().finding()->gain, 1.2);
    EXPECT_EQ(tracer.table_trial().finding()->frame, 0U);
    EXPECT_TRUE(tracer.table_trial().gave_up());
    const FrameCounters last = tracer.last_frame_counters();
    EXPECT_EQ(last.cell_lookups, 0U);
    EXPECT_EQ(last.table_updates, 0U);
    settings.sampler = Sampler::bsdf;
    EXPECT_EQ(tracer.radiance().mean, rendered("open_sky.glb", settings, 3).radiance().mean);
  }
}

// With Sobol' points, seeds whose pilot is least certain.
TEST(TableTrial, DecidesUnderAnEvenSkyBeforeTheFirstFrame) {
  RenderSettings settings = settings_of(Nee::one_ray);
  settings.width = settings.height = 128;
  settings.max_bounces = settings.russian_roulette_start = 8;
  settings.environment = {1, 1, 1};
  settings.random = RandomNumbers::sobol;
  for (const std::uint32_t seed : {7U, 9U, 12U, 14U, 15U, 17U, 20U}) {
    settings.seed = seed;
    EXPECT_TRUE(rendered("open_sky.glb", settings, 1).table_trial().gave_up()) << seed;
  }
}

// What the pilot took stands in the first frame's counts: its time does, too.
TEST(TableTrial, CountsItsPilotInTheFirstFrame) {
  RenderSettings settings = settings_of(Nee::one_ray);
  const Tracer first = rendered("occluded.glb", settings, 1);
  const Tracer second = rendered("occluded.glb", settings, 2);
  EXPECT_EQ(first.last_frame_counters().paths, 64U * 64U + 24U * 32U * 32U);
  EXPECT_EQ(second.last_frame_counters().paths, 64U * 64U);
  EXPECT_GT(first.last_frame_counters().rays, 2 * second.last_frame_counters().rays);
}

// A sky so bright that samples overflow: they count as 0, and the list says where in the image, and that it
// was before the first frame. Both kinds of numbers, as their frames differ.
TEST(TableTrial, LocatesSamplesOfItsPilotThatAreNotFinite) {
  for (const RandomNumbers random : {RandomNumbers::independent, RandomNumbers::sobol}) {
    RenderSettings settings = settings_of(Nee::one_ray);
    settings.environment = {3e38F, 3e38F, 3e38F};
    settings.random = random;
    const Tracer tracer = rendered("open_sky.glb", settings, 1);
    const std::vector<NonFiniteSample> samples = tracer.non_finite_samples();
    EXPECT_GT(std::ranges::count(samples, 0U, &NonFiniteSample::frame), 0);
    EXPECT_EQ(samples.size(), tracer.last_frame_counters().non_finite);
    std::uint32_t rightmost = 0, lowest = 0;
    for (const NonFiniteSample& sample : samples) {
      EXPECT_LT(sample.x, 64U);
      EXPECT_LT(sample.y, 64U);
      EXPECT_LE(sample.frame, 1U);
      if (sample.frame == 0) {
        rightmost = std::max(rightmost, sample.x);
        lowest = std::max(lowest, sample.y);
      }
    }
    EXPECT_GE(std::max(rightmost, lowest), 32U) << "pixels of the pilot, not of the image";
  }
}

TEST(TableTrial, KeepsTheTableBehindABlocker) {
  const Tracer tracer = rendered("occluded.glb", settings_of(Nee::one_ray), 33);
  ASSERT_TRUE(tracer.table_trial().finding());
  EXPECT_GT(tracer.table_trial().finding()->gain, 1.4);
  EXPECT_TRUE(tracer.table_trial().is_decided());
  EXPECT_FALSE(tracer.table_trial().gave_up());
  EXPECT_GT(tracer.last_frame_counters().cell_lookups, 0U);
}

// Without light samples, chance finds the lamp behind the door so rarely that frames without the table look
// calm.
TEST(TableTrial, KeepsTheTableWhereLightIsMissedWithoutIt) {
  const Tracer tracer = rendered("door_ajar.glb", settings_of(Nee::none), 33);
  EXPECT_FALSE(tracer.table_trial().gave_up());
}

}  // namespace
}  // namespace qtrace::test
