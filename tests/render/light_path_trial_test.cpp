// Where light paths are given up, and where they are not.
#include "tests/render/comparison.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

RenderSettings light_path_settings(LightPaths paths) {
  RenderSettings settings = square_settings(64, 6, Nee::one_ray);
  settings.light_paths = paths;
  return settings;
}

Tracer rendered(const char* name, const RenderSettings& settings, int frames) {
  Tracer tracer(device(), shipped(name), settings);
  for (int i = 0; i < frames; ++i) tracer.render_frame();
  return tracer;
}

// The camera sees a lamp and all that it lights: light paths have nothing to add that pays for them. A run
// that gives them up is the one that never had any, bit by bit, its table's trial included.
TEST(LightPathTrial, GivesThemUpInAnOpenRoomAndLeavesNoTrace) {
  RenderSettings settings = light_path_settings(LightPaths::trace);
  settings.sampler = Sampler::rl;
  const Tracer tracer = rendered("simple.glb", settings, 3);
  ASSERT_TRUE(tracer.light_path_trial().finding());
  EXPECT_TRUE(tracer.light_path_trial().gave_up()) << tracer.light_path_trial().finding()->gain;
  EXPECT_EQ(tracer.last_frame_counters().light_rays, 0U);
  settings.light_paths = LightPaths::none;
  EXPECT_EQ(tracer.radiance().mean, rendered("simple.glb", settings, 3).radiance().mean);
}

TEST(LightPathTrial, KeepsThemWhereALampStandsInAFixture) {
  const Tracer tracer = rendered("lamp_in_fixture.glb", light_path_settings(LightPaths::trace), 1);
  ASSERT_TRUE(tracer.light_path_trial().finding());
  EXPECT_FALSE(tracer.light_path_trial().gave_up()) << tracer.light_path_trial().finding()->gain;
  EXPECT_GT(tracer.last_frame_counters().light_rays, 0U);
}

}  // namespace
}  // namespace qtrace::test
