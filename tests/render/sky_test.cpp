// Images of the environment: where they are seen, what they light, and how they are drawn from.
#include "engine/device_scene/scene_features.h"
#include "engine/device_scene/sky_table.h"
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include "engine/scene/analytic.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>
#include <random>

namespace qtrace::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSigmas = 4;
constexpr int kSize = 16;

RenderSettings settings_of(int max_bounces, Nee nee = Nee::none) {
  return square_settings(kSize, max_bounces, nee);
}

EnvironmentMap random_sky(std::uint32_t width, std::uint32_t height) {
  std::mt19937 random(3);
  std::exponential_distribution<float> law(1);
  EnvironmentMap map{width, height, {}, 0};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    map.radiance.emplace_back(law(random), law(random), law(random));
  }
  return map;
}

// As EnvironmentMap describes it, in double precision.
glm::dvec3 radiance_of(const EnvironmentMap& map, const glm::dvec3& d) {
  // The rotation turns the image with it.
  const double turned = std::atan2(d.x, -d.z) + double{map.rotation};
  double u = turned / (2 * kPi) + 0.5;
  u -= std::floor(u);
  const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi;
  const double x = u * map.width - 0.5, y = v * map.height - 0.5;
  const auto at = [&](double column, double row) {
    const auto n = static_cast<double>(map.width);
    const auto c = static_cast<std::size_t>(column - n * std::floor(column / n));
    const auto r = static_cast<std::size_t>(std::clamp(row, 0.0, map.height - 1.0));
    return glm::dvec3(map.radiance[r * map.width + c]);
  };
  const double a = x - std::floor(x), b = y - std::floor(y), x0 = std::floor(x), y0 = std::floor(y);
  return glm::mix(glm::mix(at(x0, y0), at(x0 + 1, y0), a), glm::mix(at(x0, y0 + 1), at(x0 + 1, y0 + 1), a),
                  b);
}

// The sky in the middle of a picture towards `direction`.
glm::dvec3 seen(const EnvironmentMap& map, const glm::vec3& direction) {
  Scene scene;
  scene.environment = map;
  scene.camera = look_at({0, 0, 0}, direction, 1e-3F);
  const Rendering r = render(scene, settings_of(0), 1);
  return r.image.mean[kSize * kSize / 2 + kSize / 2];
}

TEST(Sky, IsSeenWhereTheImageHasIt) {
  for (const float rotation : {0.0F, 1.0F, -2.5F}) {
    EnvironmentMap map = random_sky(8, 5);
    map.rotation = rotation;
    for (const glm::vec3 d :
         {glm::vec3(0, 0, -1), glm::vec3(1, 0.2F, 0.1F), glm::vec3(-1, -0.5F, -0.3F),
          glm::vec3(0.1F, 3, 0.2F), glm::vec3(-0.1F, -9, 0.1F), glm::vec3(0.01F, 0.3F, 1)}) {
      const glm::dvec3 truth = radiance_of(map, glm::normalize(glm::dvec3(d)));
      EXPECT_LT(glm::length(seen(map, d) - truth), 2e-3 * glm::length(truth));
    }
  }
}

// The middle of the image lies towards -z, its right half towards +x, and a quarter turn brings the middle to
// -x.
TEST(Sky, StandsAsTheConventionSays) {
  EnvironmentMap map{8, 4, std::vector<glm::vec3>(32, glm::vec3(0)), 0};
  for (std::size_t row = 0; row < 4; ++row) map.radiance[row * 8 + 6] = glm::vec3(1);  // three quarters along
  EXPECT_GT(seen(map, {0.9F, 0, 0.4F}).r, 0.9);
  EXPECT_EQ(seen(map, {-1, 0, 0}).r, 0);
  map.rotation = static_cast<float>(kPi / 2);  // what was at +x turns to -z
  EXPECT_GT(seen(map, {0.4F, 0, -0.9F}).r, 0.9);
  EXPECT_EQ(seen(map, {0.9F, 0, 0.4F}).r, 0);
}

// A white floor under the sky shows its irradiance over pi, by every method.
TEST(Sky, LightsAFloorByItsIrradiance) {
  EnvironmentMap map = random_sky(12, 6);
  map.rotation = 0.7F;
  map.radiance[17] = glm::vec3(900, 400, 100);  // a sun
  double irradiance = 0;
  constexpr int kSteps = 600;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < 4 * kSteps; ++j) {
      const double y = (i + 0.5) / kSteps, phi = 2 * kPi * (j + 0.5) / (4 * kSteps), r = std::sqrt(1 - y * y);
      const glm::dvec3 l = radiance_of(map, {r * std::cos(phi), y, r * std::sin(phi)});
      irradiance += (l.r + l.g + l.b) / 3 * y * 2 * kPi / (4.0 * kSteps * kSteps);
    }
  }
  Scene scene;
  scene.environment = map;
  scene.materials = {lambert(glm::vec3(0.8F))};
  add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
  scene.camera = look_at({0, 1, 0.1F}, {0, 0, 0}, 0.1F);
  std::vector<Estimate> means;
  for (const LightChoice lights : {LightChoice::power, LightChoice::learned}) {
    for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
      for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
        SCOPED_TRACE(std::string(enum_name(sampler)) + " " + std::string(enum_name(nee)));
        RenderSettings settings = settings_of(1, nee);
        settings.sampler = sampler;
        settings.lights = lights;
        const Rendering r = render(scene, settings, nee == Nee::none ? 512 : 32);
        means.push_back(block_estimate(r.image, 0, 0, kSize));
        EXPECT_NEAR(means.back().mean, 0.8 * irradiance / kPi,
                    kSigmas * std::sqrt(means.back().variance) + 1e-3 * irradiance);
        EXPECT_EQ(r.non_finite, 0U);
      }
    }
  }
  // At as many samples: bsdf with one_ray (32 frames) and with none (512).
  EXPECT_LT(32 * means[1].variance, 0.1 * 512 * means[0].variance);
}

// A lamp and a sky are chosen between. The lamp is dim enough that its noise hides no error of the sky's
// part.
TEST(Sky, StandsBesideLamps) {
  Scene scene = lit_floor(0.8F, 2, 1, 1).scene;
  scene.environment = random_sky(6, 4);
  std::vector<Estimate> means;
  for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
    for (const LightChoice lights : {LightChoice::power, LightChoice::uniform, LightChoice::learned}) {
      if (nee == Nee::none && lights != LightChoice::power) continue;
      RenderSettings settings = settings_of(3, nee);
      settings.lights = lights;
      means.push_back(block_estimate(render(scene, settings, 192).image, 0, 0, kSize));
    }
  }
  for (std::size_t i = 1; i < means.size(); ++i) {
    EXPECT_LT(z_score(means[0], means[i]), kSigmas) << i << ": " << means[0].mean << " " << means[i].mean;
  }
}

TEST(Sky, ABlackOneIsNoLight) {
  Scene scene = lit_floor(0.8F, 30, 1, 1).scene;
  const std::size_t lights = gpu::find_features(scene).lights;
  scene.environment = EnvironmentMap{4, 2, std::vector<glm::vec3>(8, glm::vec3(0)), 0};
  EXPECT_EQ(gpu::find_features(scene).lights, lights);
}

// Densities integrate to one, and none vanishes beside a lit texel.
TEST(Sky, DensitiesCoverWhatIsLit) {
  EnvironmentMap map{8, 4, std::vector<glm::vec3>(32, glm::vec3(0)), 0};
  map.radiance[8] = glm::vec3(5);  // at the seam
  const std::vector<gpu::SkyTexel> texels = gpu::build_sky_table(map);
  double sum = 0;
  for (std::size_t i = 0; i < 32; ++i) {
    const double row = static_cast<double>(i / 8);
    sum += double{texels[i].radiance.w} * 2 * kPi / 8 *
           (std::cos(kPi * row / 4) - std::cos(kPi * (row + 1) / 4));
  }
  EXPECT_NEAR(sum, 1, 1e-6);
  for (const std::size_t lit : {0U, 1U, 7U, 8U, 9U, 15U, 16U, 17U, 23U})
    EXPECT_GT(texels[lit].radiance.w, 0) << lit;
  for (const std::size_t dark : {2U, 10U, 24U}) EXPECT_EQ(texels[dark].radiance.w, 0) << dark;
}

}  // namespace
}  // namespace qtrace::test
