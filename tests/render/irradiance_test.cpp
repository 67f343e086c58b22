// Direct light with closed forms: a floor under a square light, and a floor under an open sky.
#include "engine/accel/traverse.h"
#include "engine/scene/analytic.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace qtrace::test {
namespace {

constexpr int kSize = 16;

RenderSettings direct_light_settings() {
  RenderSettings settings;
  settings.random = RandomNumbers::independent;
  settings.width = settings.height = kSize;
  settings.max_bounces = 1;
  settings.seed = 5;
  settings.rl.sites_per_object = 50;
  return settings;
}

// Mean over the image of the closed form, by a fine grid of camera rays in double precision.
double expected_mean(const LitFloor& lit) {
  constexpr int kGrid = 64;
  const glm::dmat4 m(lit.scene.camera.world_from_camera);
  const double reach = std::tan(lit.scene.camera.vertical_fov / 2.0);
  double sum = 0;
  for (int y = 0; y < kGrid; ++y) {
    for (int x = 0; x < kGrid; ++x) {
      const glm::dvec2 ndc((2 * x + 1.0) / kGrid - 1, 1 - (2 * y + 1.0) / kGrid);
      const glm::dvec3 d =
          glm::dvec3(m[0]) * ndc.x * reach + glm::dvec3(m[1]) * ndc.y * reach - glm::dvec3(m[2]);
      const glm::dvec3 origin(m[3]);
      const glm::dvec3 hit = origin - d * (origin.y / d.y);
      sum += lit.radiance(hit.x, hit.z);
    }
  }
  return sum / (kGrid * kGrid);
}

TEST(Irradiance, FloorUnderSquareLight) {
  const LitFloor lit = lit_floor(0.8F, 10.0F, 1.5F, 1.0F);
  const Estimate truth{expected_mean(lit), 0};
  for (const Method& method : all_methods()) {
    SCOPED_TRACE(method.name);
    const Rendering r = render(lit.scene, with_method(direct_light_settings(), method), 256);
    EXPECT_EQ(r.non_finite, 0U);
    const Estimate all = block_estimate(r.image, 0, 0, kSize);
    EXPECT_LT(z_score(all, truth), 4) << all.mean << " instead of " << truth.mean;
    EXPECT_NEAR(all.mean / truth.mean, 1, 0.02);
  }
}

// A tiny light at the origin, far from what it lights: single precision must not let it shadow itself, at any
// scale.
TEST(Irradiance, TinyLightAtTheOriginIsNotItsOwnShadow) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    LitFloor lit = lit_floor(0.8F, 1e6F, 0.02F, 5.0F);
    const Estimate truth{expected_mean(lit), 0};
    // Tilted, so that no coordinate is exact by chance.
    const glm::mat3 tilt(glm::rotate(glm::mat4(1), 0.7F, glm::normalize(glm::vec3(1, 0.4F, -0.6F))));
    const auto place = [&](glm::vec3 p) { return tilt * (p - glm::vec3(0, 5, 0)) * scale; };
    for (Triangle& t : lit.scene.triangles) {
      for (glm::vec3& p : t.position) p = place(p);
      for (glm::vec3& n : t.normal) n = tilt * n;
    }
    glm::mat4& camera = lit.scene.camera.world_from_camera;
    const glm::vec3 eye = place(glm::vec3(camera[3]));
    camera = glm::mat4(tilt) * camera;
    camera[3] = glm::vec4(eye, 1);
    for (const Method& method : all_methods()) {
      if (method.nee == Nee::none) continue;  // finds so small a light too rarely
      SCOPED_TRACE(testing::Message() << method.name << ", scale " << scale);
      const Rendering r = render(lit.scene, with_method(direct_light_settings(), method), 64);
      EXPECT_NEAR(block_estimate(r.image, 0, 0, kSize).mean / truth.mean, 1, 0.01);
    }
  }
}

// Under an open sky of radiance Ls and the square light: rho (Ls (1 - F) + Le F), F the light's share of the
// hemisphere weighted by the cosine.
TEST(Irradiance, FloorUnderSkyAndSquareLight) {
  const double sky = 2;
  const LitFloor lit = lit_floor(0.8F, 10.0F, 1.5F, 1.0F);
  const double light_part = expected_mean(lit);
  const Estimate truth{double{lit.albedo} * sky + light_part * (1 - sky / lit.emission), 0};
  for (const Method& method : all_methods()) {
    SCOPED_TRACE(method.name);
    RenderSettings settings = with_method(direct_light_settings(), method);
    settings.environment = {sky, sky, sky};
    const Estimate all = block_estimate(render(lit.scene, settings, 256).image, 0, 0, kSize);
    EXPECT_LT(z_score(all, truth), 4) << all.mean << " instead of " << truth.mean;
    EXPECT_NEAR(all.mean / truth.mean, 1, 0.02);
  }
}

// A floor that sees the whole sky reflects albedo times its radiance.
TEST(Irradiance, FloorUnderOpenSky) {
  Scene scene;
  scene.materials.push_back(lambert(glm::vec3(0.5F)));
  add_quad(scene, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, 0);
  scene.camera = look_at({1, 2, 1}, {0, 0, 0}, 0.3F);
  for (const Method& method : all_methods()) {
    SCOPED_TRACE(method.name);
    RenderSettings settings = with_method(direct_light_settings(), method);
    settings.environment = {2, 2, 2};
    const Estimate all = block_estimate(render(scene, settings, 256).image, 0, 0, kSize);
    EXPECT_LT(z_score(all, {1.0, 0}), 4) << all.mean;
  }
}

// Emission leaves the front face alone, and both faces of a double-sided material.
TEST(Irradiance, EmissionIsOneSidedUnlessDoubleSided) {
  for (const bool double_sided : {false, true}) {
    for (const Method& method : all_methods()) {
      SCOPED_TRACE(method.name + (double_sided ? ", double-sided" : ", one-sided"));
      LitFloor lit = lit_floor(0.8F, 10.0F, 1.5F, 1.0F);
      Scene& scene = lit.scene;
      for (Triangle& t : scene.triangles) {
        if (t.material != 1) continue;
        std::swap(t.position[1], t.position[2]);
        for (glm::vec3& n : t.normal) n = -n;
      }
      scene.materials[1].double_sided = double_sided;
      const Estimate truth{double_sided ? expected_mean(lit) : 0.0, 0};
      const Estimate all =
          block_estimate(render(scene, with_method(direct_light_settings(), method), 128).image, 0, 0, kSize);
      EXPECT_LT(z_score(all, truth), 4) << all.mean << " instead of " << truth.mean;
    }
  }
}

}  // namespace
}  // namespace qtrace::test
