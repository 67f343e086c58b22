// Lights without a surface on a floor: KHR_lights_punctual in closed form.
#include "tests/support/render.h"
#include "tests/support/statistics.h"

#include "engine/core/check.h"
#include "engine/scene/analytic.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace qtrace::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSize = 16;

Scene floor_below(const std::vector<PunctualLight>& lights) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.8F, 0.4F, 0.2F))};
  add_quad(scene, {-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, 0);
  scene.lights = lights;
  scene.camera = look_at({0, 3, 0.1F}, {1, 0, 0.5F}, 1e-4F);
  return scene;
}

RenderSettings settings_of(Nee nee) {
  RenderSettings settings;
  settings.width = settings.height = kSize;
  settings.sampler = Sampler::bsdf;
  settings.max_bounces = 1;
  settings.nee = nee;
  return settings;
}

void expect_irradiance(const Scene& scene, const glm::dvec3& irradiance) {
  for (const Nee nee : {Nee::one_ray, Nee::two_ray}) {
    for (const LightChoice lights : {LightChoice::power, LightChoice::learned}) {
      RenderSettings settings = settings_of(nee);
      settings.lights = lights;
      const Rendering r = render(scene, settings, 64);
      const glm::dvec3 truth = glm::dvec3(scene.materials[0].base_color) * irradiance / kPi;
      glm::dvec3 mean(0);
      for (const glm::dvec3& pixel : r.image.mean) mean += pixel / (1.0 * kSize * kSize);
      const double error = scene.lights.size() > 1 ? 0.03 : 1e-3;
      EXPECT_LT(glm::length(mean - truth), error * glm::length(truth) + 1e-9)
          << enum_name(nee) << ": " << mean.r << " instead of " << truth.r;
    }
  }
}

// The point of the floor that the camera looks at.
const glm::dvec3 kPoint(1, 0, 0.5);

glm::dvec3 from_point(const PunctualLight& light) {
  const glm::dvec3 way = glm::dvec3(light.position) - kPoint;
  const double d = glm::length(way);
  const double window = std::clamp(1 - std::pow(d / double{light.range}, 4), 0.0, 1.0);
  return glm::dvec3(light.intensity) * (way.y / d) / (d * d) * window;
}

TEST(Punctual, PointsFallOffByTheSquareOfTheDistance) {
  PunctualLight light;
  light.position = {0, 2, 0};
  light.intensity = {10, 20, 30};
  expect_irradiance(floor_below({light}), from_point(light));
  light.range = 3;
  expect_irradiance(floor_below({light}), from_point(light));
  light.range = 2;
  expect_irradiance(floor_below({light}), glm::dvec3(0));
}

TEST(Punctual, SpotsFadeBetweenTheirCones) {
  PunctualLight light;
  light.kind = PunctualLight::Kind::spot;
  light.position = {0, 2, 0};
  light.direction = {0, -1, 0};
  light.intensity = {10, 20, 30};
  light.inner_cone_angle = 0.2F;
  for (const float outer : {0.4F, 0.6F, 1.2F}) {
    SCOPED_TRACE(outer);
    light.outer_cone_angle = outer;
    const double cosine = 2 / glm::length(glm::dvec3(0, 2, 0) - kPoint);
    const double low = std::cos(double{outer});
    const double part = std::clamp((cosine - low) / (std::cos(double{0.2F}) - low), 0.0, 1.0);
    expect_irradiance(floor_below({light}), from_point(light) * part * part);
  }
}

TEST(Punctual, DirectionalOnesBringTheirLux) {
  PunctualLight light;
  light.kind = PunctualLight::Kind::directional;
  light.direction = glm::normalize(glm::vec3(1, -1, 0));
  light.intensity = {3, 2, 1};
  expect_irradiance(floor_below({light}), glm::dvec3(light.intensity) * std::sqrt(0.5));
}

TEST(Punctual, SeveralAddUp) {
  PunctualLight point, sun;
  point.position = {0, 2, 0};
  point.intensity = {10, 20, 30};
  sun.kind = PunctualLight::Kind::directional;
  sun.direction = {0, -1, 0};
  sun.intensity = {3, 2, 1};
  expect_irradiance(floor_below({point, sun}), from_point(point) + glm::dvec3(sun.intensity));
}

TEST(Punctual, AWallBetweenKeepsThemOut) {
  PunctualLight point, sun;
  point.position = {0, 2, 0};
  sun.kind = PunctualLight::Kind::directional;
  sun.direction = {0, -1, 0};
  Scene scene = floor_below({point, sun});
  add_quad(scene, {-5, 1.9F, -5}, {0, 0, 10}, {10, 0, 0}, 0);
  scene.camera = look_at({0, 1, 0.1F}, {1, 0, 0.5F}, 1e-4F);
  for (const Nee nee : {Nee::one_ray, Nee::two_ray}) {
    for (const glm::dvec3& pixel : render(scene, settings_of(nee), 4).image.mean)
      EXPECT_EQ(pixel, glm::dvec3(0));
  }
}

TEST(Punctual, PathsAloneAreRefused) {
  PunctualLight light;
  light.name = "bulb";
  try {
    render(floor_below({light}), settings_of(Nee::none), 1);
    FAIL() << "rendered";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'bulb'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("one_ray or two_ray would be right"), std::string::npos);
  }
}

}  // namespace
}  // namespace qtrace::test
