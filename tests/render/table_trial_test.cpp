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
  const Tracer tracer = rendered("open_sky.glb", settings, 33);
  ASSERT_TRUE(tracer.trial().finding());
  EXPECT_NEAR(tracer.trial().finding()->gain, 1.08, 0.12);
  EXPECT_TRUE(tracer.trial().gave_up());
  const FrameCounters last = tracer.last_frame_counters();
  EXPECT_EQ(last.cell_lookups, 0U);
  EXPECT_EQ(last.table_updates, 0U);
}

TEST(TableTrial, KeepsTheTableBehindABlocker) {
  const Tracer tracer = rendered("occluded.glb", settings_of(Nee::one_ray), 33);
  ASSERT_TRUE(tracer.trial().finding());
  EXPECT_GT(tracer.trial().finding()->gain, 1.4);
  EXPECT_TRUE(tracer.trial().is_decided());
  EXPECT_FALSE(tracer.trial().gave_up());
  EXPECT_GT(tracer.last_frame_counters().cell_lookups, 0U);
}

// Without light samples, chance finds the lamp behind the door so rarely that frames without the table look
// calm.
TEST(TableTrial, KeepsTheTableWhereLightIsMissedWithoutIt) {
  const Tracer tracer = rendered("door_ajar.glb", settings_of(Nee::none), 33);
  EXPECT_FALSE(tracer.trial().gave_up());
}

}  // namespace
}  // namespace qtrace::test
