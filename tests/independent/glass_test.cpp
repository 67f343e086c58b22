// Mirrors and smooth glass against the formulas of Fresnel's factor, Snell and Beer.
#include "tests/independent/small_scenes.h"

namespace qtrace::independent {
namespace {

const glm::dvec3 kToEye = glm::normalize(glm::dvec3(0.3, 0.6, 0.5));  // from a floor
const double kCosine = kToEye.y;

// From 0 at the top to 1 at the bottom, by the angle.
EnvironmentMap gradient() {
  EnvironmentMap map{2, 512, {}, 0};
  for (std::uint32_t j = 0; j < map.height; ++j) {
    const float value = (static_cast<float>(j) + 0.5F) / static_cast<float>(map.height);
    map.radiance.insert(map.radiance.end(), map.width, glm::vec3(value));
  }
  return map;
}
double gradient_at(double up) { return std::acos(up) / M_PI; }

// A square floor under the gradient.
Scene floor_of(const Material& material) {
  Scene scene;
  scene.materials = {material};
  add_quad(scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 0);
  scene.environment = gradient();
  return scene;
}

Seen seen_at(const Scene& scene, const glm::dvec3& to_eye, int samples = 40'000) {
  return seen_from(scene, glm::vec3(to_eye), glm::vec3(0), one_pixel(1, samples));
}

double schlick(double f0, double f90, double cosine) { return f0 + (f90 - f0) * std::pow(1 - cosine, 5); }

TEST(Independent, MirrorsMetalByItsColor) {
  Material metal;
  metal.roughness = 0.004F;
  metal.base_color = {0.9F, 0.6F, 0.3F};
  const double sky = gradient_at(kCosine);
  const Seen found = seen_at(floor_of(metal), kToEye, 1);
  expect_near(found.mean,
              sky * glm::dvec3(schlick(0.9, 1, kCosine), schlick(0.6, 1, kCosine), schlick(0.3, 1, kCosine)),
              1e-5);
}

TEST(Independent, MirrorsAndPassesByThinGlass) {
  Material thin = glass(0, true, 2);
  thin.base_color = {0.9F, 0.6F, 0.3F};
  thin.specular = 0.8F;
  thin.specular_color = {2, 1, 0.5F};
  thin.metallic = 0.25F;
  const glm::dvec3 f(schlick(0.8 * 2 / 9, 0.8, kCosine), schlick(0.8 / 9, 0.8, kCosine),
                     schlick(0.8 * 0.5 / 9, 0.8, kCosine));
  for (const double side : {1.0, -1.0}) {  // from above, and from below all the same
    glm::dvec3 expected;
    for (int k = 0; k < 3; ++k) {
      const double base = thin.base_color[k];
      const double mirrored = 0.75 * f[k] + 0.25 * schlick(base, 1, kCosine);
      const double passed = 0.75 * base * (1 - f.x);  // f.x is the largest
      expected[k] = mirrored * gradient_at(side * kCosine) + passed * gradient_at(-side * kCosine);
    }
    expect_about(seen_at(floor_of(thin), side * kToEye), expected);
  }
}

// Radiance over the squared index stays the same where light is refracted.
TEST(Independent, RefractsIntoAVolume) {
  const double inner = std::sqrt(1 - (1 - kCosine * kCosine) / 2.25);
  const double f = schlick(0.04, 1, kCosine);
  const double expected = f * gradient_at(kCosine) + (1 - f) / 2.25 * gradient_at(-inner);
  expect_about(seen_at(floor_of(glass(0, false)), kToEye), glm::dvec3(expected));
}

TEST(Independent, RefractsOutOfAVolume) {
  const glm::dvec3 to_eye = glm::normalize(glm::dvec3(0.3, -0.6, 0.2));
  const double outer = std::sqrt(1 - (1 - to_eye.y * to_eye.y) * 2.25);  // the side of the lower index
  const double f = schlick(0.04, 1, outer);
  const double expected = f * gradient_at(to_eye.y) + (1 - f) * 2.25 * gradient_at(outer);
  expect_about(seen_at(floor_of(glass(0, false)), to_eye), glm::dvec3(expected));
}

TEST(Independent, ReflectsAllWhereNothingLeavesAVolume) {
  Material volume = glass(0, false);
  volume.specular = 0;  // what cannot leave is reflected all the same
  const glm::dvec3 to_eye = glm::normalize(glm::dvec3(0.3, -0.4, 0.4));
  expect_about(seen_at(floor_of(volume), to_eye), glm::dvec3(gradient_at(to_eye.y)), 0.02);
}

// Its reflectance is `specular` at all angles, and the rest is scattered: see
// Independent.LightsAFloorByTheSky for what a white floor has of the gradient.
TEST(Independent, PassesNothingWithoutAnIndex) {
  for (const bool is_thin : {true, false}) {
    Material material = glass(0, is_thin, 0);
    material.specular = 0.5F;
    material.base_color = glm::vec3(0.6F);
    expect_about(seen_at(floor_of(material), kToEye),
                 glm::dvec3(0.5 * gradient_at(kCosine) + 0.5 * 0.6 * 0.25));
  }
}

// A slab of depth 1 before a lamp. Of what its faces reflect, two reflections more come back in four bounces.
TEST(Independent, AttenuatesByBeersLaw) {
  Material volume = glass(0, false);
  volume.attenuation_color = {0.9F, 0.5F, 0.2F};
  volume.attenuation_distance = 2;
  volume.base_color = glm::vec3(0.9F);
  Scene scene = wall(volume);
  add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {2, 0, 0}, 0);
  add_wall(scene, -2.5F, emitter(glm::vec3(4)));
  const glm::dvec3 once = glm::sqrt(glm::dvec3(0.9, 0.5, 0.2));
  const double passes = 0.9 * 0.96;
  const glm::dvec3 straight = passes * passes * once * 4.0;
  const auto found = [&](int bounces) {
    return seen_from(scene, {0.2F, 0.1F, 2}, {0.2F, 0.1F, 0}, one_pixel(bounces, 100'000));
  };
  expect_about(found(2), straight);
  expect_about(found(4), straight * (1.0 + 0.04 * 0.04 * once * once));
}

TEST(Independent, KeepsTheVolumeThroughAThinSheet) {
  Material volume = glass(0, false, 1);
  volume.attenuation_color = {0.9F, 0.5F, 0.2F};
  volume.attenuation_distance = 1;
  Material sheet = glass(0, true);
  sheet.specular = 0;
  Scene scene = wall(volume);
  add_quad(scene, {-1, -1, -1}, {0, 2, 0}, {2, 0, 0}, 0);
  add_wall(scene, -0.5F, sheet);
  add_wall(scene, -2.5F, emitter(glm::vec3(4)));
  expect_about(seen_from(scene, {0.2F, 0.1F, 2}, {0.2F, 0.1F, 0}, one_pixel(3, 50'000)),
               4.0 * glm::dvec3(volume.attenuation_color));
}

// A lamp and what it lights, in a volume that bends nothing: its head-on reflectance is 0.
TEST(Independent, AttenuatesSamplesOfLightsInsideAVolume) {
  Material volume = glass(0, false, 1);
  volume.attenuation_color = {0.9F, 0.5F, 0.2F};
  volume.attenuation_distance = 1;
  Scene scene = wall(lambert(glm::vec3(0.5F)));
  add_wall(scene, 1, volume);
  PunctualLight lamp;
  lamp.position = {0.1F, 0.1F, 0.5F};
  scene.lights.push_back(lamp);
  const glm::dvec3 expected = 0.5 / M_PI / 0.25 * glm::pow(glm::dvec3(0.9, 0.5, 0.2), glm::dvec3(1.5));
  expect_about(seen_from(scene, {0.1F, 0.1F, 3}, {0.1F, 0.1F, 0}, one_pixel(2, 20'000)), expected);
}

// A mirror whose normals' texture leans so far that its mirror direction would be in the floor: it is lifted.
TEST(Independent, MirrorsAboveTheSurfaceWhateverItsTextureSays) {
  Material metal;
  metal.roughness = 0;
  Scene scene = floor_of(metal);
  scene.materials[0].texture(TextureSlot::normal) = add_image(scene, 1, {{255, 128, 140, 255}});
  TriangleAttributes attributes;
  attributes.tangent.fill(glm::vec4(1, 0, 0, 1));
  set_attributes(scene, attributes);
  expect_near(seen_at(scene, glm::normalize(glm::dvec3(-0.5, 0.6, 0)), 1).mean, glm::dvec3(gradient_at(1e-3)),
              1e-3);
}

}  // namespace
}  // namespace qtrace::independent
