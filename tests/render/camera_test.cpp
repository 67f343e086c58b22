// Orthographic cameras against closed forms: where their rays meet a wall, and how much of the picture a lamp
// fills.
#include "engine/scene/analytic.h"
#include "tests/support/render.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace qtrace::test {
namespace {

constexpr float kWidth = 1, kHeight = 0.5F;  // of the lamp

// A lamp of radiance 4 about the origin that faces +z, in a picture of 3 by 2, seen from `distance`.
Scene lamp_seen_from(float distance) {
  Scene scene;
  scene.name = "lamp";
  scene.materials.emplace_back().base_color = glm::vec3(0);
  scene.materials[0].emission = glm::vec3(4);
  const glm::vec3 a(-kWidth / 2, -kHeight / 2, 0), b(kWidth / 2, -kHeight / 2, 0),
      c(kWidth / 2, kHeight / 2, 0), d(-kWidth / 2, kHeight / 2, 0), n(0, 0, 1);
  scene.triangles.push_back({{a, b, c}, {n, n, n}, {}, 0, 0});
  scene.triangles.push_back({{a, c, d}, {n, n, n}, {}, 0, 0});
  scene.objects.push_back({"lamp", 0, 2, false});
  scene.camera.world_from_camera = glm::translate(glm::mat4(1), glm::vec3(0, 0, distance));
  scene.camera.film_height = 2;
  return scene;
}

RenderSettings settings() {
  RenderSettings result;
  result.width = 48;
  result.height = 32;
  result.max_bounces = 1;
  return result;
}

TEST(Orthographic, RaysAreParallel) {
  for (const float distance : {0.5F, 40.0F}) {
    const FirstHitImage hits = Tracer(device(), lamp_seen_from(distance), settings()).first_hit();
    std::size_t on_lamp = 0;
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 48; ++x) {
        const auto i = static_cast<std::size_t>(48 * y + x);
        const float across = (static_cast<float>(x) + 0.5F) / 16 - 1.5F,
                    up = 1 - (static_cast<float>(y) + 0.5F) / 16;
        const bool is_lamp = std::abs(across) < kWidth / 2 && std::abs(up) < kHeight / 2;
        ASSERT_EQ(hits.normal[i].z > 0, is_lamp) << x << ' ' << y;
        if (!is_lamp) continue;
        ++on_lamp;
        EXPECT_NEAR(hits.position[i].x, across, 1e-5);
        EXPECT_NEAR(hits.position[i].y, up, 1e-5);
      }
    }
    EXPECT_EQ(on_lamp, 16U * 8U);
  }
}

// As a file of points alone: every ray finds the environment, exactly.
TEST(EmptyScene, ShowsTheEnvironment) {
  Scene nothing;
  for (const Method& method : all_methods()) {
    for (const BvhKind bvh : {BvhKind::sah, BvhKind::threaded}) {
      RenderSettings s = with_method(settings(), method);
      s.bvh = bvh;
      s.environment = {0.5, 1, 2};
      const Rendering found = render(nothing, s, 2);
      EXPECT_EQ(found.non_finite, 0U);
      for (const glm::dvec3& pixel : found.image.mean) ASSERT_EQ(pixel, glm::dvec3(0.5, 1, 2)) << method.name;
    }
  }
}

// The lamp fills a twelfth of the picture from wherever it is seen.
TEST(Orthographic, ALampFillsItsShareOfThePicture) {
  for (const float distance : {0.5F, 40.0F}) {
    const Rendering found = render(lamp_seen_from(distance), settings(), 4);
    double mean = 0;
    for (const glm::dvec3& pixel : found.image.mean)
      mean += pixel.g / static_cast<double>(found.image.pixels());
    EXPECT_NEAR(mean, 4 * kWidth * kHeight / 6, 1e-6);  // the lamp's borders are those of pixels
  }
}

}  // namespace
}  // namespace qtrace::test
