// Runs that need the same shaders share their programs, and do not disturb one another.
#include "engine/scene/analytic.h"
#include "tests/support/render.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

RenderSettings learning_settings() {
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = 16;
  settings.sampler = Sampler::rl;
  settings.rl.sites_per_object = 4;
  return settings;
}

TEST(ProgramCache, ASecondTracerCompilesNothing) {
  const Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
  RenderSettings settings = learning_settings();
  settings.rl.bins_theta = 3;  // of no other test
  settings.rl.bins_phi = 7;
  const std::size_t before = device().programs().compiled();
  const Tracer first(device(), scene, settings);
  const std::size_t compiled = device().programs().compiled();
  EXPECT_GE(compiled, before + 4);  // of paths, the initial table, the list of cells and their update
  settings.seed = 2;
  settings.width = 32;
  const Tracer second(device(), scene, settings);
  EXPECT_EQ(device().programs().compiled(), compiled);
  settings.rl.bins_theta = 7;
  settings.rl.bins_phi = 3;
  const Tracer third(device(), scene, settings);
  EXPECT_EQ(device().programs().compiled(), compiled + 4);
}

TEST(ProgramCache, TracersThatShareProgramsRenderTheirOwnFrames) {
  const Scene scene = lit_floor(0.8F, 10, 1, 1).scene;
  Tracer alone(device(), scene, learning_settings());
  for (int frame = 0; frame < 4; ++frame) alone.render_frame();
  const RadianceImage expected = alone.radiance();
  Tracer one(device(), scene, learning_settings());
  RenderSettings other_settings = learning_settings();
  other_settings.seed = 5;
  Tracer other(device(), scene, other_settings);
  for (int frame = 0; frame < 4; ++frame) {
    one.render_frame();
    other.render_frame();
    other.render_frame();
  }
  EXPECT_EQ(one.radiance().mean, expected.mean);
  EXPECT_NE(other.radiance().mean, expected.mean);
}

// More variants than are kept: a program that is in use stays, and works.
TEST(ProgramCache, ForgetsProgramsThatNobodyUses) {
  gpu::ProgramCache cache;
  device();
  const auto kept = cache.get("passes/accumulate.comp", {});
  for (int i = 0; i < 70; ++i) cache.get("passes/accumulate.comp", {{"VARIANT", std::to_string(i)}});
  const std::size_t compiled = cache.compiled();
  EXPECT_EQ(compiled, 71U);
  EXPECT_EQ(cache.get("passes/accumulate.comp", {}), kept);
  EXPECT_EQ(cache.compiled(), compiled);
  cache.get("passes/accumulate.comp", {{"VARIANT", "0"}});
  EXPECT_EQ(cache.compiled(), compiled + 1);
}

}  // namespace
}  // namespace qtrace::test
