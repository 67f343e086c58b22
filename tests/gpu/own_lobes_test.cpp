// Chi-squared, as in sampler_test.cpp, over the whole sphere: of materials whose BSDF keeps lobes of its own.
// Draws of smooth lobes have no density; they are counted, and their weights are the lobes' reflectance.
#include "tests/gpu/sampler_stage.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace qtrace::test {
namespace {

constexpr double kSamples = SamplerStage::kSamples;
constexpr float kBase = 0.8F;
// Where facets stand upright, the density of what passes rough glass ends at once, at -cosine / index: at an
// edge of the grid, which its quadrature does not blur.
constexpr float kFromOutside = 1.5F * 3 / 16;
constexpr float kFromWithin = 0.25F;

double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

struct LobesCase {
  std::string name;
  Material material;
  double smooth_reflectance = 0;  // of all smooth lobes, towards the viewer
  bool back = false;
  float cosine = kFromOutside;
};

Material dielectric(float roughness, float transmission, bool is_thin = true) {
  Material m;
  m.base_color = glm::vec3(kBase);
  m.metallic = 0;
  m.roughness = roughness;
  m.transmission = transmission;
  m.is_thin = is_thin;
  return m;
}

Material metal(float roughness) {
  Material m = dielectric(roughness, 0);
  m.metallic = 1;
  return m;
}

Material coated(Material m, float coat_roughness) {
  m.clearcoat = 0.7F;
  m.clearcoat_roughness = coat_roughness;
  return m;
}

std::vector<LobesCase> rough_cases() {
  const Material volume = dielectric(0.5F, 1, false);
  const double coat = 0.7 * schlick(0.04, kFromOutside);
  Material lambert = dielectric(1, 0);
  lambert.specular = 0;
  return {{"rough thin glass", dielectric(0.5F, 1)},
          {"rough thin glass from behind", dielectric(0.5F, 1), 0, true},
          {"rough glass", volume},
          {"rough glass from within", volume, 0, true, 0.9F},
          // Beyond the critical angle the surface reflects all, but for what facets let pass.
          {"rough glass from within, at a low angle", volume, 0, true, kFromWithin},
          {"half of plastic passed", dielectric(0.5F, 0.5F)},
          {"half of plastic passed from within", dielectric(0.4F, 0.5F, false), 0, true, 0.8F},
          {"rough coat on rough metal", coated(metal(0.6F), 0.4F)},
          {"rough coat on rough glass", coated(dielectric(0.4F, 0.8F, false), 0.5F)},
          {"smooth coat on Lambert", coated(lambert, 0), coat}};
}

std::vector<LobesCase> smooth_cases() {
  const double f = schlick(0.04, kFromOutside);
  const double index2 = 1.5 * 1.5;
  // From within, by the cosine outside.
  const double out = schlick(0.04, std::sqrt(1 - (1 - 0.9 * 0.9) * index2));
  return {{"mirror", metal(0), schlick(double{kBase}, kFromOutside)},
          {"smooth plastic", dielectric(0, 0), f},
          {"smooth half of plastic passed", dielectric(0, 0.5F), f + (1 - f) * 0.5 * kBase},
          {"smooth glass", dielectric(0, 1, false), f + (1 - f) * kBase / index2},
          {"smooth glass from within", dielectric(0, 1, false), out + (1 - out) * kBase * index2, true, 0.9F},
          {"smooth glass from within, at a low angle", dielectric(0, 1, false), 1, true, kFromWithin},
          {"smooth coat on smooth plastic", coated(dielectric(0, 0), 0), 0.7 * f + (1 - 0.7 * f) * f}};
}

// Three samplers, and the table with a part of the BSDF's.
std::vector<SamplerCase> with_samplers(const LobesCase& c) {
  std::vector<SamplerCase> all;
  for (const auto& [name, sampler, fraction] :
       std::vector<std::tuple<std::string, Sampler, double>>{{"bsdf", Sampler::bsdf, 0},
                                                             {"uniform", Sampler::uniform, 0},
                                                             {"random table", Sampler::rl, 0},
                                                             {"random table and bsdf", Sampler::rl, 0.3}}) {
    all.push_back({c.name + ", " + name, sampler, fraction, 1, c.material, false, c.back, c.cosine});
  }
  all.push_back(all[0]);
  all.back().name += ", tilted";
  all.back().tilted = true;
  return all;
}

// As many smooth draws as their share says, with the weights that their lobes reflect; the others by their
// density, which is short of one by those that fall outside.
void expect_stated(const Draws& draws, const Stated& stated, const LobesCase& c, std::size_t comparisons) {
  constexpr double kQuadrature = 2e-4 * kSamples;
  const double z = z_threshold(comparisons);
  const double share = stated.smooth_share;
  EXPECT_NEAR(draws.smooth, share * kSamples, z * std::sqrt(share * (1 - share) * kSamples) + 0.5);
  EXPECT_NEAR(draws.weight, c.smooth_reflectance,
              z * std::sqrt(draws.weight_variance) + 1e-4 * c.smooth_reflectance);
  const double with_density = std::accumulate(stated.counts.begin(), stated.counts.end(), 0.0);
  const double outside = (1 - share) * kSamples - with_density;
  EXPECT_NEAR(draws.outside, outside, z * std::sqrt(std::max(outside, 0.0)) + kQuadrature);
  if (share > 1 - 1e-6) {
    EXPECT_EQ(draws.smooth, kSamples);
  } else {
    EXPECT_GT(chi_squared_p(draws.counts, stated.counts), kFalseAlarm / static_cast<double>(comparisons));
  }
}

void expect_all_stated(const std::vector<LobesCase>& cases) {
  device();
  constexpr std::size_t kEach = 4 * 6;  // comparisons of four kinds
  const std::size_t comparisons = cases.size() * kEach;
  for (const LobesCase& c : cases) {
    for (const SamplerCase& with : with_samplers(c)) {
      SCOPED_TRACE(with.name);
      const SamplerStage stage(with);
      expect_stated(stage.draws(), stage.stated(), c, comparisons);
      if (with.sampler != Sampler::uniform) continue;
      SCOPED_TRACE("draw_bsdf()");
      expect_stated(stage.draws(Drawer::bsdf), stage.stated(Drawer::bsdf), c, comparisons);
    }
  }
}

TEST(OwnLobes, OfRoughMaterialsDrawWhatTheyState) { expect_all_stated(rough_cases()); }

TEST(OwnLobes, OfSmoothMaterialsDrawWhatTheyState) { expect_all_stated(smooth_cases()); }

}  // namespace
}  // namespace qtrace::test
