// Punctual lights, images of the sky, and cameras, against closed forms.
#include "tests/independent/environment.h"
#include "tests/independent/small_scenes.h"

#include <glm/trigonometric.hpp>

namespace qtrace::independent {
namespace {

// What a Lambert wall of albedo 0.5 shows at its middle.
double seen_on_wall(const std::vector<PunctualLight>& lights, bool sample_lights = true) {
  Scene scene = wall(lambert(glm::vec3(0.5F)));
  scene.lights = lights;
  Options options = one_pixel(1);
  options.sample_lights = sample_lights;
  return seen_from(scene, {0.6F, 0.1F, 0.5F}, glm::vec3(0), options).mean.x;
}

PunctualLight lamp_at(glm::vec3 position, float intensity) {
  PunctualLight light;
  light.position = position;
  light.intensity = glm::vec3(intensity);
  return light;
}

constexpr double kWhite = 0.5 / M_PI;  // radiance over irradiance

TEST(Independent, LightsByTheInverseSquare) {
  const double distance2 = 0.36 + 1.44, cosine = 1.2 / std::sqrt(distance2);
  const PunctualLight lamp = lamp_at({0.6F, 0, 1.2F}, 3);
  const double expected = kWhite * 3 * cosine / distance2;
  EXPECT_NEAR(seen_on_wall({lamp}), expected, kExact);
  EXPECT_EQ(seen_on_wall({lamp}, false), 0);
  const PunctualLight above = sun({0, 0.6F, -0.8F}, glm::vec3(2));
  EXPECT_NEAR(seen_on_wall({above}), kWhite * 2 * 0.8, kExact);
  EXPECT_NEAR(seen_on_wall({lamp, above, lamp}), kWhite * (2 * 3 * cosine / distance2 + 2 * 0.8), kExact);
}

TEST(Independent, EndsLightsAtTheirRange) {
  PunctualLight lamp = lamp_at({0, 0, 2}, 3);
  lamp.range = 2.5F;
  EXPECT_NEAR(seen_on_wall({lamp}), kWhite * 3 / 4 * (1 - std::pow(0.8, 4)), kExact);
  lamp.range = 1.9F;
  EXPECT_EQ(seen_on_wall({lamp}), 0);
}

TEST(Independent, FadesSpotLightsBetweenTheirCones) {
  PunctualLight spot = lamp_at({0, 0, 2}, 3);
  spot.kind = PunctualLight::Kind::spot;
  spot.inner_cone_angle = 0.3F;
  spot.outer_cone_angle = 0.6F;
  const auto turned_by = [&](double angle) {
    spot.direction = {static_cast<float>(std::sin(angle)), 0, static_cast<float>(-std::cos(angle))};
    return seen_on_wall({spot}) / (kWhite * 3 / 4);
  };
  EXPECT_NEAR(turned_by(0.29), 1, kExact);
  EXPECT_NEAR(turned_by(0.45),
              std::pow((std::cos(0.45) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6)), 2), 1e-5);
  EXPECT_EQ(turned_by(0.61), 0);
}

TEST(Independent, ShadowsEndAtTheLight) {
  Scene scene = wall(lambert(glm::vec3(0.5F)));
  add_wall(scene, 1, lambert(glm::vec3(0)));
  const auto found = [&](const PunctualLight& light) {
    scene.lights = {light};
    return seen_from(scene, {0.6F, 0.1F, 0.5F}, glm::vec3(0), one_pixel(1)).mean.x;
  };
  EXPECT_NEAR(found(lamp_at({0, 0, 0.9F}, 3)), kWhite * 3 / 0.81, kExact);
  EXPECT_EQ(found(lamp_at({0, 0, 1.1F}, 3)), 0);
  EXPECT_EQ(found(sun({0, 0, -1}, glm::vec3(3))), 0);
}

// Four columns, three rows; every texel of another radiance.
EnvironmentMap numbered() {
  EnvironmentMap map{4, 3, {}, 0};
  for (int i = 0; i < 12; ++i) map.radiance.emplace_back(i % 4, 10 * (i / 4), 1);
  return map;
}

TEST(Independent, ShowsTheSkyWhereItsImageSays) {
  Scene scene;
  scene.environment = numbered();
  const auto towards = [&](double right_of_middle, double up) {  // degrees
    const double a = glm::radians(right_of_middle), e = glm::radians(up);
    const glm::dvec3 d(std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a));
    Options options = one_pixel(1);
    options.environment = glm::dvec3(99);  // the image is in its place
    return seen_from(scene, glm::vec3(0), glm::vec3(d), options).mean;
  };
  expect_near(towards(45, 0), {2, 10, 1});
  expect_near(towards(135, 0), {3, 10, 1});
  expect_near(towards(-45, 0), {1, 10, 1});
  expect_near(towards(-135, 0), {0, 10, 1});
  expect_near(towards(0, 0), {1.5, 10, 1});
  expect_near(towards(180, 0), {1.5, 10, 1});  // the seam, between 3 and 0
  expect_near(towards(157.5, 0), {2.25, 10, 1});
  expect_near(towards(45, 60), {2, 0, 1});
  expect_near(towards(45, 80), {2, 0, 1});
  expect_near(towards(45, 30), {2, 5, 1});
  expect_near(towards(45, -75), {2, 20, 1});
  scene.environment->rotation = static_cast<float>(M_PI / 4);  // the middle turns to the left
  expect_near(towards(0, 0), {2, 10, 1});
  expect_near(towards(90, 0), {3, 10, 1});
}

TEST(Independent, DrawsDirectionsOfTheSkyWithTheirDensity) {
  EnvironmentMap map = numbered();
  map.rotation = 0.7F;
  for (std::size_t i = 0; i < 8; ++i) map.radiance[i] = glm::vec3(0);
  map.radiance[6] = glm::vec3(500);
  const Environment sky(map);
  glm::dvec3 whole(0);
  double chance = 0, least = 1e300;
  constexpr int kSteps = 600;
  for (int i = 0; i < 2 * kSteps * kSteps; ++i) {
    const double y = 2 * (i / (2 * kSteps) + 0.5) / kSteps - 1,
                 phi = M_PI * (i % (2 * kSteps) + 0.5) / kSteps;
    const double sine = std::sqrt(1 - y * y);
    const glm::dvec3 d(sine * std::cos(phi), y, sine * std::sin(phi));
    const double step = 2 * M_PI / kSteps / kSteps;
    whole += step * sky.radiance(d);
    chance += step * sky.density(d);
    least = std::min(least, sky.density(d));
  }
  EXPECT_NEAR(chance, 1, 2e-3);
  EXPECT_GT(least, 1e-5);
  Random random{std::mt19937_64(6)};
  glm::dvec3 sum(0), squares(0);
  constexpr int kSamples = 200'000;
  for (int i = 0; i < kSamples; ++i) {
    const Environment::Sample s = sky.sample(random);
    ASSERT_NEAR(s.density, sky.density(s.direction), 1e-9 * s.density);
    const glm::dvec3 value = sky.radiance(s.direction) / s.density;
    sum += value, squares += value * value;
  }
  const glm::dvec3 mean = sum / double{kSamples};
  const glm::dvec3 error = glm::sqrt((squares / double{kSamples} - mean * mean) / double{kSamples});
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], whole[k], kSigmas * error[k] + 1e-3 * whole[k]);
}

// Radiance of a / pi at the angle a from the zenith: the irradiance is 2 times the integral of
// a cos a sin a from 0 to pi / 2, which is pi / 4.
TEST(Independent, LightsAFloorByTheSky) {
  Scene scene;
  scene.materials = {lambert(glm::vec3(0.8F))};
  add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
  EnvironmentMap map{4, 256, {}, 0};
  for (std::uint32_t j = 0; j < map.height; ++j) {
    map.radiance.insert(map.radiance.end(), 4, glm::vec3((static_cast<float>(j) + 0.5F) / 256));
  }
  scene.environment = map;
  for (const bool sample_lights : {true, false}) {
    SCOPED_TRACE(sample_lights);
    Options options = one_pixel(1, 40'000);
    options.sample_lights = sample_lights;
    expect_about(seen_from(scene, {1, 1, 1}, glm::vec3(0), options), glm::dvec3(0.8 / M_PI * M_PI / 4));
  }
}

// A picture of 2 x 1 in the world, of a wall with four colours.
TEST(Independent, OrthographicRaysAreParallel) {
  Scene scene = wall(emitter(glm::vec3(1)));
  Texture texture = add_image(scene, 2, {{255, 0, 0, 0}, {0, 255, 0, 0}, {0, 0, 255, 0}, {255, 255, 0, 0}});
  texture.is_nearest = true;
  scene.materials[0].texture(TextureSlot::emission) = texture;
  scene.camera = look_at({0.5F, 0, 5}, {0.5F, 0, 0}, 1);
  scene.camera.film_height = 1;
  Options options = one_pixel(0, 50);
  options.width = 4;
  options.height = 2;
  options.environment = glm::dvec3(9);
  // Pixels are half as wide as a colour; the last column looks past the wall.
  const std::vector<glm::dvec3> expected{{0, 0, 1}, {1, 1, 0}, {1, 1, 0}, {9, 9, 9},
                                         {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {9, 9, 9}};
  EXPECT_EQ(trace(scene, options).mean, expected);
}

}  // namespace
}  // namespace qtrace::independent
