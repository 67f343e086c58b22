// Light that goes the other way is reflected alike (Helmholtz): a factor of one side alone, such as masking
// without shadowing, is seen here in every sample, and in whole images hardly at all.
#include "tests/support/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kPairs = 1 << 14;
// Rounding of a narrow lobe's half vector, and of what is left where nearly all is reflected.
constexpr float kTolerance = 2e-3F;
constexpr float kSlack = 1e-6F;

// Of each, x and y: f in both directions of time. `body`: sets them for random `a` and `c` above the surface,
// seen from above, `u` and `v` in [0, 1). The lobes of smooth surfaces are left out: they have no density to
// compare.
std::vector<glm::vec4> both_ways(const std::string& body, const gpu::Defines& defines) {
  device();
  return probe<glm::vec4>("vec4", {"material/own_lobes.glsl", "sampling/random.glsl"},
                          "vec3 upward(vec2 u) {\n"
                          "  float r = sqrt(1.0 - u.x * u.x);\n"
                          "  return vec3(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), u.x);\n"
                          "}\n",
                          "vec4 u = random_units(RandomKey(index, 1u, 7u), 1u);\n"
                          "vec4 v = random_units(RandomKey(index, 2u, 7u), 1u);\n"
                          "vec3 a = upward(vec2(0.05 + 0.95 * u.x, u.y));\n"
                          "vec3 c = upward(vec2(0.05 + 0.95 * u.z, u.w));\n"
                          "Surface s;\n"
                          "s.normal = s.geometric_normal = vec3(0.0, 0.0, 1.0);\n"
                          "Bsdf b;\n"
                          "b.base_color = v.xyz;\n"
                          "b.dielectric_f0 = vec4(0.04, 0.04, 0.04, 1.0);\n"
                          "b.alpha = 0.05 + 0.9 * fract(v.x * 17.0);\n" +
                              body,
                          kPairs, defines);
}

void expect_equal(const std::vector<glm::vec4>& results) {
  for (const glm::vec4& r : results) EXPECT_NEAR(r.x, r.y, kTolerance * std::max(r.x, r.y) + kSlack);
}

// Materials of random colour, metallic and roughness.
TEST(Reciprocity, OfGlossySurfaces) {
  const auto results = both_ways(
      "b.metallic = v.w < 0.3 ? 0.0 : v.w > 0.7 ? 1.0 : v.w;\n"
      "result = vec4(average(bsdf_cosine(s, b, a, c)) / c.z, average(bsdf_cosine(s, b, c, a)) / a.z, 0.0, 0.0);",
      {{"HAS_SPECULAR", "1"}});
  for (const glm::vec4& r : results) EXPECT_GT(r.x, 0);
  expect_equal(results);
}

// What passes a rough surface, and the same way back, seen from below.
const char* const kThroughBothWays = R"(
  b.metallic = 0.3;
  b.transmission = 0.8;
  vec3 below = -c;
  float forth = average(bsdf_cosine(s, b, a, below)) / c.z;
  b.far_index = 1.0 / b.far_index;
  s.normal = s.geometric_normal = vec3(0.0, 0.0, -1.0);
  float back = average(bsdf_cosine(s, b, below, a)) / a.z;
)";
const gpu::Defines kTransmission{{"HAS_SPECULAR", "1"}, {"HAS_OWN_LOBES", "1"}, {"HAS_TRANSMISSION", "1"}};

TEST(Reciprocity, OfRoughThinGlass) {
  const auto results = both_ways("b.bends = false;\nb.far_index = 1.0;\n" + std::string(kThroughBothWays) +
                                     "result = vec4(forth, back, 0.0, 0.0);",
                                 kTransmission);
  for (const glm::vec4& r : results) EXPECT_GT(r.x, 0);
  expect_equal(results);
}

// Over the squared index of the side that the light leaves to (Veach 1997, section 5.2): here that of the
// viewer's, which is 1 on one way and `ratio` on the other.
TEST(Reciprocity, OfRoughVolumesOverTheSquaredIndex) {
  const auto results =
      both_ways("float ratio = 1.1 + v.w;\nb.bends = true;\nb.far_index = ratio;\n" +
                    std::string(kThroughBothWays) + "result = vec4(forth, back / (ratio * ratio), 0.0, 0.0);",
                kTransmission);
  expect_equal(results);
  // Pairs of directions without a facet between them have none on either way.
  EXPECT_GT(std::ranges::count_if(results, [](const glm::vec4& r) { return r.x > 1000 * kSlack; }),
            kPairs / 8);
}

// A coat's Fresnel factor goes by the angle of the viewer alone (KHR_materials_clearcoat), which is not
// reciprocal: here it stands still, and the base is black.
TEST(Reciprocity, OfCoatsWithoutTheirReflectance) {
  const auto results = both_ways(
      "s.coat_normal = s.normal;\n"
      "b.metallic = 1.0;\nb.base_color = vec3(0.0);\nb.dielectric_f0 = vec4(0.0);\n"
      "b.coat = 0.5;\nb.coat_alpha = 0.05 + 0.9 * v.y;\n"
      "result = vec4(own_lobes_cosine(s, b, a, c).x / c.z, own_lobes_cosine(s, b, c, a).x / a.z, 0.0, 0.0);",
      {{"HAS_SPECULAR", "1"}, {"HAS_OWN_LOBES", "1"}, {"HAS_CLEARCOAT", "1"}});
  for (const glm::vec4& r : results) EXPECT_GT(r.x, 0);
  expect_equal(results);
}

}  // namespace
}  // namespace qtrace::test
