// What ./dev bench times as the steps of a frame is the tracer's own frame.
#include "tests/bench/staged_frame.h"
#include "tests/support/device.h"

#include "engine/gltf/load_gltf.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

// With everything that targets are gathered for, learned anew after every frame as there.
TEST(StagedFrame, RendersTheTracersImageInEveryForm) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/occluded.glb");
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = 24;
  settings.sampler = Sampler::rl;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  settings.rl.total_sites = 200;
  settings.rl.update_growth = 0;
  bench::StagedFrame staged(device(), scene, settings);
  EXPECT_NO_THROW(bench::check_same_image(device(), scene, settings, staged));
}

}  // namespace
}  // namespace qtrace::test
