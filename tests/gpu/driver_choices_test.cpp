// However shaders are compiled for a driver, what is computed is the same: one way is chosen, all must be right.
#include "engine/gpu/driver.h"
#include "engine/gltf/load_gltf.h"
#include "tests/support/render.h"
#include "tests/support/goswami.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

using gpu::Fetch;
using gpu::StackPlace;

RadianceImage image_by(const Scene& scene, const RenderSettings& settings, const gpu::DriverChoices& choices) {
  Tracer tracer(device(), scene, settings, gpu::with_choices({}, choices));
  return render(tracer, 4).image;
}

TEST(DriverChoices, AllRenderTheSame) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/many_lights.glb");
  RenderSettings settings;
  settings.rl = goswami_table();
  settings.width = settings.height = 32;
  settings.sampler = Sampler::rl;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  settings.rl.sites_per_object = 20;
  for (const BvhKind bvh : {BvhKind::sah, BvhKind::threaded}) {
    SCOPED_TRACE(enum_name(bvh));
    settings.bvh = bvh;
    const RadianceImage plain = image_by(scene, settings, {Fetch::texture, StackPlace::memory, 1});
    for (const Fetch fetch : {Fetch::texture, Fetch::image, Fetch::storage}) {
      if (!gpu::offers(fetch)) continue;
      SCOPED_TRACE(gpu::fetch_name(fetch));
      EXPECT_EQ(plain.mean, image_by(scene, settings, {fetch, StackPlace::registers, 2}).mean);
      if (bvh == BvhKind::threaded) continue;  // which has no stack
      EXPECT_EQ(plain.mean, image_by(scene, settings, {fetch, StackPlace::memory, 3}).mean);
    }
  }
}

}  // namespace
}  // namespace qtrace::test
