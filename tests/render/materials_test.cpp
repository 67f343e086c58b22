// Mirrors, glass, coats and volumes where closed forms are known: under a sky of 1 nothing shines brighter
// than 1.
#include "tests/support/render.h"
#include "tests/support/statistics.h"
#include "tests/support/textured_quad.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace qtrace::test {
namespace {

constexpr int kSize = 16;
constexpr double kSigmas = 4;

RenderSettings settings_of(int max_bounces, double sky = 1) {
  RenderSettings settings = square_settings(kSize, max_bounces);
  settings.russian_roulette_start = 1000;
  settings.environment = {sky, sky, sky};
  return settings;
}

Material dielectric(float roughness) {
  Material m;
  m.base_color = glm::vec3(1);
  m.metallic = 0;
  m.roughness = roughness;
  return m;
}

// A square of the material, looked at under this angle from its normal, in front or from behind.
Scene square(const Material& material, double angle, bool behind = false) {
  Scene scene;
  scene.materials = {material};
  add_quad(scene, {-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, 0);
  const double z = behind ? -std::cos(angle) : std::cos(angle);
  scene.camera = look_at(5.0F * glm::vec3(static_cast<float>(std::sin(angle)), 0, static_cast<float>(z)),
                         {0, 0, 0}, 1e-3F);
  return scene;
}

Estimate shown(const Scene& scene, const RenderSettings& settings, int frames) {
  const Rendering r = render(scene, settings, frames);
  EXPECT_EQ(r.non_finite, 0U);
  return block_estimate(r.image, 0, 0, kSize);
}

void expect_near(const Estimate& estimate, double truth) {
  EXPECT_NEAR(estimate.mean, truth, kSigmas * std::sqrt(estimate.variance) + 2e-4 * truth);
}

double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

double f0_of(double ior) { return std::pow((ior - 1) / (ior + 1), 2); }

// A mirror of metal shows the sky times its colour by Schlick, whoever samples.
TEST(Mirrors, ReflectByTheirColour) {
  for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
    for (const double angle : {0.1, 0.8, 1.4}) {
      Material m;
      m.base_color = glm::vec3(0.6F);
      m.roughness = 0;
      RenderSettings settings = settings_of(1, 2);
      settings.sampler = sampler;
      expect_near(shown(square(m, angle), settings, 4), 2 * schlick(double{0.6F}, std::cos(angle)));
    }
  }
}

// A smooth dielectric is a mirror over a Lambert base. The base's reflectance is an integral of Schlick's
// term at half vectors, which is checked where it vanishes: on a black base.
TEST(Mirrors, OfBlackPlasticReflectBySchlick) {
  for (const double angle : {0.1, 0.8, 1.4}) {
    Material m = dielectric(0);
    m.base_color = glm::vec3(0);
    expect_near(shown(square(m, angle), settings_of(1), 4), schlick(double{0.04F}, std::cos(angle)));
  }
}

TEST(Glass, ThinWallsLetPassWhatTheyDoNotReflect) {
  for (const double angle : {0.1, 0.8, 1.4}) {
    for (const bool behind : {false, true}) {
      Material m = dielectric(0);
      m.transmission = 1;
      m.base_color = glm::vec3(0.5F);
      m.ior = 1.7F;
      const double f = schlick(f0_of(double{1.7F}), std::cos(angle));
      expect_near(shown(square(m, angle, behind), settings_of(1), 64), f + 0.5 * (1 - f));
    }
  }
}

// Seen through a slab of glass in a wide volume: total reflection from within, and radiance back at its own
// after two surfaces.
TEST(Glass, SlabsAreAsClearAsTheirSurfaces) {
  Material m = dielectric(0);
  m.transmission = 1;
  m.is_thin = false;
  m.ior = 1.5F;
  for (const double angle : {0.0, 0.9}) {
    Scene scene = square(m, angle);
    add_quad(scene, {-50, -50, -1}, {0, 100, 0}, {100, 0, 0}, 0);  // its back, facing away
    // Two bounces: through both surfaces, or back from one.
    const double f = schlick(f0_of(1.5), std::cos(angle));
    expect_near(shown(scene, settings_of(2), 256), f + (1 - f) * (1 - f));
    // All of them: what the surfaces do not lose is all.
    expect_near(shown(scene, settings_of(64), 256), 1);
  }
}

TEST(Glass, VolumesAbsorbByTheirLength) {
  Material m = dielectric(0);
  m.transmission = 1;
  m.is_thin = false;
  m.ior = 1;  // straight through, without a reflection
  m.attenuation_color = {0.5F, 0.25F, 1};
  m.attenuation_distance = 2;
  Scene scene = square(m, 0);
  add_quad(scene, {-50, -50, -3}, {0, 100, 0}, {100, 0, 0}, 0);
  const Rendering r = render(scene, settings_of(2), 16);
  const glm::dvec3 pixel = r.image.mean[0];
  EXPECT_NEAR(pixel.r, std::pow(0.5, 1.5), 1e-3);
  EXPECT_NEAR(pixel.g, std::pow(0.25, 1.5), 1e-3);
  EXPECT_NEAR(pixel.b, 1, 1e-3);
}

// From within, beyond the critical angle: all is reflected, and the path ends in the volume's own light.
TEST(Glass, ReflectsInFullBeyondTheCriticalAngle) {
  for (const float roughness : {0.0F, 0.2F}) {
    Material m = dielectric(roughness);
    m.transmission = 1;
    m.is_thin = false;
    m.ior = 1.5F;
    m.base_color = glm::vec3(0);  // nothing passes
    Scene scene = square(m, 1.2, true);
    const Estimate seen = shown(scene, settings_of(1), 256);
    if (roughness == 0) expect_near(seen, 1);
    EXPECT_GT(seen.mean, 0.9);
    EXPECT_LE(seen.mean, 1 + kSigmas * std::sqrt(seen.variance));
  }
}

// A closed ball of glass in a white world is white: nothing is won, and what is lost is single scattering's.
TEST(Glass, SmoothBallsVanishInAWhiteWorld) {
  Material m = dielectric(0);
  m.transmission = 1;
  m.is_thin = false;
  m.ior = 1.5F;
  Scene scene = furnace_box(0, 0);
  scene.materials = {m};
  // The box turned inside out: its walls face outwards.
  for (Triangle& t : scene.triangles) {
    std::swap(t.position[1], t.position[2]);
    for (glm::vec3& n : t.normal) n = -n;
  }
  scene.camera = look_at({4, 3, 5}, {0, 0, 0}, 0.3F);
  expect_near(shown(scene, settings_of(64), 256), 1);
}

TEST(Coats, AreOverTheBase) {
  for (const double angle : {0.1, 0.8, 1.4}) {
    Material m = lambert(glm::vec3(0.5F));
    m.clearcoat = 0.8F;
    m.clearcoat_roughness = 0;
    const double coat = 0.8 * schlick(double{0.04F}, std::cos(angle));
    expect_near(shown(square(m, angle), settings_of(1), 256), coat + (1 - coat) * 0.5);
    m.emission = glm::vec3(7);
    expect_near(shown(square(m, angle), settings_of(0), 4), (1 - coat) * 7);
  }
}

TEST(Unlit, EmitsItsBaseColourAndReflectsNothing) {
  for (const bool behind : {false, true}) {
    Material m = dielectric(0.5F);
    m.base_color = {0.25F, 0.5F, 0.75F};
    m.is_unlit = true;
    m.emission = glm::vec3(9);
    m.clearcoat = 1;
    for (const glm::dvec3& pixel : render(square(m, 0.5, behind), settings_of(3), 4).image.mean) {
      EXPECT_LT(glm::length(pixel - glm::dvec3(0.25, 0.5, 0.75)), 1e-6);
    }
  }
}

// Unlit surfaces light what paths find them from, and are no lights: all methods agree.
TEST(Unlit, LightsAlikeByEveryMethod) {
  Scene scene = lit_floor(0.8F, 1, 1, 1).scene;
  Material m;
  m.base_color = glm::vec3(1);
  m.is_unlit = true;
  scene.materials.push_back(m);
  add_quad(scene, {-3, 0, -3}, {0, 2, 0}, {6, 0, 0}, static_cast<std::uint32_t>(scene.materials.size() - 1));
  std::vector<Estimate> means;
  for (const Nee nee : {Nee::none, Nee::one_ray, Nee::two_ray}) {
    RenderSettings settings = settings_of(2, 0);
    settings.nee = nee;
    means.push_back(shown(scene, settings, 512));
  }
  EXPECT_LT(z_score(means[0], means[1]), kSigmas) << means[0].mean << " " << means[1].mean;
  EXPECT_LT(z_score(means[0], means[2]), kSigmas) << means[0].mean << " " << means[2].mean;
}

// Of a white Lambert base under a smooth dielectric, as glTF 2.0 mixes them (Appendix B): what is not
// reflected at the half vector of both directions. It does not fall with the angle as what enters does, so at
// grazing angles the two make light.
double diffuse_below(double f0, double angle) {
  constexpr int kSteps = 400;
  const glm::dvec3 v(std::sin(angle), 0, std::cos(angle));
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double r2 = (i + 0.5) / kSteps, phi = 2 * std::numbers::pi * (j + 0.5) / kSteps;
      const glm::dvec3 l(std::sqrt(r2) * std::cos(phi), std::sqrt(r2) * std::sin(phi), std::sqrt(1 - r2));
      sum += 1 - schlick(f0, glm::dot(v, glm::normalize(v + l)));
    }
  }
  return sum / (kSteps * kSteps);
}

// White furnaces: no material makes light, at any roughness and angle, whoever samples; but for that mix,
// which makes as much as its formula says.
struct Furnace {
  const char* name;
  Material material;
  double diffuse;  // part of what enters
};

std::vector<Furnace> furnaces(float roughness) {
  Material metal;
  metal.roughness = roughness;
  Material thin = dielectric(roughness);
  thin.transmission = 1;
  Material glass = thin;
  glass.is_thin = false;
  Material half = glass;
  half.transmission = 0.5F;
  Material coated = metal;
  coated.clearcoat = 1;
  coated.clearcoat_roughness = roughness;
  return {{"metal", metal, 0},       {"plastic", dielectric(roughness), 1},
          {"thin glass", thin, 0},   {"glass", glass, 0},
          {"half glass", half, 0.5}, {"coated metal", coated, 0}};
}

TEST(WhiteFurnace, NoMaterialMakesLight) {
  for (const float roughness : {0.0F, 0.01F, 0.1F, 0.3F, 0.6F, 1.0F}) {
    for (const Furnace& f : furnaces(roughness)) {
      for (const double angle : {0.0, 0.8, 1.45}) {
        for (const bool behind : {false, true}) {
          std::vector<Estimate> means;
          for (const Sampler sampler : {Sampler::bsdf, Sampler::uniform, Sampler::rl}) {
            if (sampler != Sampler::bsdf && (roughness < 0.3F || angle > 1)) continue;
            SCOPED_TRACE(std::string(f.name) + ", roughness " + std::to_string(roughness) + ", angle " +
                         std::to_string(angle) + (behind ? ", behind, " : ", ") +
                         std::string(enum_name(sampler)));
            RenderSettings settings = settings_of(1);
            settings.sampler = sampler;
            const Estimate seen = shown(square(f.material, angle, behind), settings, 64);
            // Within glass, radiance is that of the sky at the square of its index: brightness is compared
            // with it.
            const bool inside = behind && !f.material.is_thin;
            const double f0 = f0_of(1.5), reflected = schlick(f0, std::cos(angle));
            const double passing = (1 - f.diffuse) * (1 - reflected) / (f.material.is_thin ? 1 : 1.5 * 1.5);
            const double mixed = reflected + f.diffuse * diffuse_below(f0, angle) + passing;
            const double most = inside ? 1.5 * 1.5 : f.material.metallic > 0 ? 1 : mixed;
            EXPECT_LE(seen.mean, most + kSigmas * std::sqrt(seen.variance) + 2e-3);
            if (roughness == 0 && !inside) {
              EXPECT_NEAR(seen.mean, most, kSigmas * std::sqrt(seen.variance) + 2e-3);
            }
            EXPECT_GE(seen.mean, 0.3);
            means.push_back(seen);
          }
          for (std::size_t i = 1; i < means.size(); ++i) {
            EXPECT_LT(z_score(means[0], means[i]), 5)
                << f.name << " " << roughness << " " << angle << " " << behind << ": " << means[0].mean << " "
                << means[i].mean;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace qtrace::test
