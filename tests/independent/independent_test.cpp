// The independent tracer against closed forms, and the renderer against the independent tracer.
#include "tests/independent/comparison.h"
#include "tests/independent/path_tracer.h"

#include "engine/scene/analytic.h"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace qtrace::independent {
namespace {

TEST(Independent, FindsTheFurnacesNeumannSum) {
  const Scene scene = furnace_box(0.7F, 1.5F);
  for (const int bounces : {0, 1, 5}) {
    SCOPED_TRACE(bounces);
    Options options;
    options.width = options.height = 8;
    options.samples = 1;
    options.max_bounces = bounces;
    options.sample_lights = false;
    // In a furnace, every path brings the same.
    for (const glm::dvec3& pixel : trace(scene, options).mean) {
      EXPECT_NEAR(pixel.x, furnace_radiance(double{0.7F}, 1.5, bounces), 1e-12);
    }
  }
}

TEST(Independent, FindsTheFloorUnderALight) {
  const LitFloor lit = lit_floor(0.8F, 3, 1, 2);
  Options options;
  options.width = options.height = 1;
  options.max_bounces = 1;
  options.samples = 20'000;
  Scene scene = lit.scene;
  scene.camera = look_at({3, 1, 3}, {0.5F, 0, 0.25F}, 1e-4F);
  for (const bool sample_lights : {true, false}) {
    options.sample_lights = sample_lights;
    if (!sample_lights) options.samples *= 10;
    const Image image = trace(scene, options);
    EXPECT_NEAR(image.mean[0].x, lit.radiance(0.5, 0.25), 4 * std::sqrt(image.variance[0].x))
        << sample_lights;
    EXPECT_LT(std::sqrt(image.variance[0].x), 0.02 * image.mean[0].x);
  }
}

class Shipped : public testing::TestWithParam<const char*> {};

// With independent random numbers, and with Sobol' points: there the tracer's own noise is most of what is
// between them, as that of 256 points is far less.
TEST_P(Shipped, TheReferencesSamplerAgrees) {
  const Comparison comparison(GetParam(), {.size = 32, .samples = 256});
  for (const RandomNumbers random : {RandomNumbers::independent, RandomNumbers::sobol}) {
    const Agreement found = comparison.measure(Sampler::bsdf, Nee::one_ray, 256, 0, 0, {}, random);
    EXPECT_TRUE(found.agrees(kQuickChance)) << enum_name(random) << ": " << found.text();
    EXPECT_EQ(found.non_finite, 0U);
  }
}

// Two that take long are compared by every method in tests/slow/rooms_test.cpp.
std::vector<const char*> quick_scenes() {
  std::vector<const char*> scenes;
  for (const char* scene : kScenes) {
    if (scene != std::string_view("sunlit_bath.glb") && scene != std::string_view("lamp_in_fixture.glb"))
      scenes.push_back(scene);
  }
  return scenes;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Shipped, testing::ValuesIn(quick_scenes()), [](const auto& scene) {
  const std::string name = scene.param;
  return name.substr(0, name.find('.'));
});

}  // namespace
}  // namespace qtrace::independent
