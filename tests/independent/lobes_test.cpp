// The microfacets' lobes against integrals that have another form, and samples of them against quadrature.
#include "tests/independent/scattering.h"
#include "tests/independent/small_scenes.h"

#include <functional>
#include <string>

namespace qtrace::independent {
namespace {

// A point of a horizontal surface whose factors are its material's.
struct Setting {
  std::string name;
  Material material;
  glm::dvec3 to_eye;
  glm::dvec3 normal{0, 1, 0}, coat_normal{0, 1, 0};

  Point point() const {
    Point p;
    p.eye = glm::normalize(to_eye);
    p.from_front = to_eye.y > 0;
    const double side = p.from_front ? 1 : -1;
    p.face = {0, side, 0};
    p.normal = side * glm::normalize(normal);
    p.coat_normal = side * glm::normalize(coat_normal);
    p.material = &material;
    const Material& m = material;
    p.surface = {glm::dvec3(m.base_color),
                 glm::dvec3(m.specular_color),
                 glm::dvec3(0),
                 1,
                 m.metallic,
                 m.roughness,
                 m.specular,
                 m.transmission,
                 m.clearcoat,
                 m.clearcoat_roughness};
    return p;
  }
};

Material with(Material material, const std::function<void(Material&)>& change) {
  change(material);
  return material;
}

std::vector<Setting> settings() {
  const glm::dvec3 above(0.5, 0.7, 0.3), below(0.3, -0.8, 0.1), grazing(0.9, 0.3, 0.1);
  const Material mixed = with(glass(0.6F, true), [](Material& m) {
    m.transmission = 0.5F;
    m.metallic = 0.3F;
    m.base_color = {0.9F, 0.6F, 0.3F};
  });
  const Material coated = with(mixed, [](Material& m) {
    m.clearcoat = 0.8F;
    m.clearcoat_roughness = 0.5F;
  });
  const glm::dvec3 leaning(0.3, 0.9, -0.2), other(-0.2, 0.9, 0.3);
  return {
      {"Lambert", lambert(glm::vec3(0.8F)), above},
      {"plastic", with(Material{}, [](Material& m) { m.metallic = 0, m.roughness = 0.5F; }), grazing},
      {"thin glass", glass(0.6F, true), above},
      {"thin glass from behind", glass(0.6F, true), below},
      {"into a volume", glass(0.7F, false), above},
      {"into a volume, grazing", glass(0.7F, false), grazing},
      {"out of a volume", glass(0.7F, false), below},
      {"out of a volume, beyond the critical angle", glass(0.8F, false), {0.9, -0.5, 0}},
      {"into diamond", glass(0.5F, false, 2.4F), above},
      {"mixed", mixed, above},
      {"coated", coated, above},
      {"leaning", coated, above, leaning, other},
      {"leaning volume", with(coated, [](Material& m) { m.is_thin = false; }), above, leaning, other},
      {"leaning volume from behind", with(coated, [](Material& m) { m.is_thin = false; }), below, leaning,
       other},
  };
}

// Over all directions, about the normal, so that lobes' edges at the horizon are edges of its cells.
template <class F>
glm::dvec3 integral(const Point& p, const F& f) {
  constexpr int kSteps = 600;
  const glm::dvec3 n = p.normal, t = glm::normalize(glm::cross(n, glm::dvec3(0.9, 0.1, 0.4))),
                   b = glm::cross(n, t);
  glm::dvec3 sum(0);
  for (int i = 0; i < 2 * kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps - 1, sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < kSteps; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / kSteps;
      sum += glm::dvec3(f(glm::normalize(cosine * n + sine * (std::cos(phi) * t + std::sin(phi) * b))));
    }
  }
  return sum * (2 * M_PI / kSteps / kSteps);
}

TEST(Independent, SamplesLobesWithTheDensityThatItTells) {
  for (const Setting& setting : settings()) {
    SCOPED_TRACE(setting.name);
    const Point p = setting.point();
    const Scattering scattering(p);
    constexpr int kSamples = 400'000;
    Random random{std::mt19937_64(3)};
    glm::dvec3 sum(0), squares(0);
    double drawn = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Scattering::Sample s = scattering.sample(random);
      if (s.density > 0) ++drawn;
      sum += s.weight, squares += s.weight * s.weight;
    }
    const glm::dvec3 mean = sum / double{kSamples};
    const glm::dvec3 error = glm::sqrt((squares / double{kSamples} - mean * mean) / double{kSamples});
    const glm::dvec3 expected = integral(p, [&](const glm::dvec3& d) { return scattered_part(p, d); });
    const double share = integral(p, [&](const glm::dvec3& d) { return scattering.density(d); }).x;
    EXPECT_NEAR(drawn / kSamples, share, kSigmas * 0.5 / std::sqrt(kSamples) + 1e-3);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(mean[k], expected[k], kSigmas * error[k] + 1e-3 * expected[k]) << "channel " << k;
      EXPECT_GT(mean[k], 0.05);
    }
  }
}

// At roughness 1, D is 1 / pi and V is 1 / (2 (N.L + N.V)): head-on, the integral of D V N.L is that of
// x / (1 + x) from 0 to 1.
TEST(Independent, RoughestLobesKeepAllButTheLogarithmOfTwo) {
  const glm::dvec3 expected(1 - std::log(2));
  Setting metal{"metal", Material{}, {0, 1, 0}};
  Setting thin{"thin", glass(1, true), {0, 1, 0}};
  thin.material.specular = 0;
  for (const Setting& setting : {metal, thin}) {
    const Point p = setting.point();
    expect_near(integral(p, [&](const glm::dvec3& d) { return scattered_part(p, d); }), expected, 1e-4);
  }
}

// The same of a volume's surface, over the facets instead of the directions: a facet at the angle a sends the
// light to the angle a - b of the axis, sin a = 1.5 sin b, and G = 2 N.L / (1 + N.L).
TEST(Independent, RoughestRefractionIsAnIntegralOverFacets) {
  Setting volume{"volume", glass(1, false), {0, 1, 0}};
  volume.material.specular = 0;
  constexpr int kSteps = 10'000;
  double expected = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = (i + 0.5) / kSteps * M_PI / 2, b = std::asin(std::sin(a) / 1.5);
    const double n_l = std::cos(a - b);
    expected += 2 * std::cos(a) * std::sin(a) * 2 * n_l / (1 + n_l) * M_PI / 2 / kSteps;
  }
  const Point p = volume.point();
  const glm::dvec3 found = integral(p, [&](const glm::dvec3& d) { return scattered_part(p, d); });
  expect_near(found, glm::dvec3(expected / 2.25), 1e-4);
}

TEST(Independent, RefractsBothWaysAlikeButForTheSquaredIndices) {
  const Setting front{"front", glass(0.5F, false), {0.5, 0.8, 0.1}};
  const Setting back{"back", glass(0.5F, false), {-0.1, -0.8, 0.2}};
  const Point above = front.point(), below = back.point();
  const glm::dvec3 down = scattered_part(above, below.eye) / std::abs(below.eye.y);
  const glm::dvec3 up = scattered_part(below, above.eye) / std::abs(above.eye.y);
  EXPECT_GT(down.x, 0.01);
  expect_near(up / 2.25, down, 1e-12);
}

TEST(Independent, NarrowLobesComeNearTheSmoothOnes) {
  for (const Setting& start : settings()) {
    SCOPED_TRACE(start.name);
    const auto mean_weight = [&](float roughness) {
      Setting setting = start;
      setting.material.roughness = setting.material.clearcoat_roughness = roughness;
      const Point p = setting.point();
      const Scattering scattering(p);
      Random random{std::mt19937_64(4)};
      glm::dvec3 sum(0);
      constexpr int kSamples = 200'000;
      for (int i = 0; i < kSamples; ++i) sum += scattering.sample(random).weight;
      return sum / double{kSamples};
    };
    expect_near(mean_weight(0.03F), mean_weight(0), 0.015);
  }
}

}  // namespace
}  // namespace qtrace::independent
