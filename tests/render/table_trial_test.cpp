// Where the table is given up, and where it is not.
#include "tests/support/render.h"

#include "engine/gltf/load_gltf.h"

#include <gtest/gtest.h>

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

// Under an even sky there is nothing to learn. Frames after the trial look up no cells and teach nothing.
TEST(TableTrial, GivesTheTableUpUnderAnEvenSky) {
  RenderSettings settings = settings_of(Nee::none);
  settings.environment = {1, 1, 1};
  const Tracer tracer = rendered("open_sky.glb", settings, 25);
  EXPECT_NEAR(tracer.trial_gain().value_or(0), 1.1, 0.05);
  EXPECT_TRUE(tracer.gave_table_up());
  const FrameCounters last = tracer.last_frame_counters();
  EXPECT_EQ(last.cell_lookups, 0U);
  EXPECT_EQ(last.table_updates, 0U);
}

TEST(TableTrial, KeepsTheTableBehindABlocker) {
  const Tracer tracer = rendered("occluded.glb", settings_of(Nee::one_ray), 25);
  EXPECT_GT(tracer.trial_gain().value_or(0), 1.5);
  EXPECT_FALSE(tracer.gave_table_up());
  EXPECT_GT(tracer.last_frame_counters().cell_lookups, 0U);
}

// Without light samples, chance finds the lamp behind the door so rarely that frames without the table look
// calm.
TEST(TableTrial, KeepsTheTableWhereLightIsMissedWithoutIt) {
  const Tracer tracer = rendered("door_ajar.glb", settings_of(Nee::none), 25);
  EXPECT_FALSE(tracer.gave_table_up());
}

}  // namespace
}  // namespace qtrace::test
