// However buffers are fetched, what is computed is the same: drivers choose one way, all must be right.
#include "engine/gpu/fetch.h"
#include "engine/gltf/load_gltf.h"
#include "tests/support/render.h"
#include "tests/support/report.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

RadianceImage image_by(const Scene& scene, const RenderSettings& settings, gpu::Fetch fetch) {
  Tracer tracer(device(), scene, settings, {{"FETCH", std::to_string(static_cast<int>(fetch))}});
  return render(tracer, 4).image;
}

TEST(Fetch, EveryWayRendersTheSame) {
  const Scene scene = load_gltf(QTRACE_SOURCE_DIR "/configs/scenes/many_lights.glb");
  RenderSettings settings;
  settings.rl = report_table();
  settings.width = settings.height = 32;
  settings.sampler = Sampler::rl;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  settings.rl.sites_per_object = 20;
  for (const BvhKind bvh : {BvhKind::sah, BvhKind::threaded}) {
    SCOPED_TRACE(enum_name(bvh));
    settings.bvh = bvh;
    const RadianceImage by_texture = image_by(scene, settings, gpu::Fetch::texture);
    EXPECT_EQ(by_texture.mean, image_by(scene, settings, gpu::Fetch::storage).mean);
    if (!gpu::offers(gpu::Fetch::image)) continue;
    EXPECT_EQ(by_texture.mean, image_by(scene, settings, gpu::Fetch::image).mean);
  }
}

}  // namespace
}  // namespace qtrace::test
