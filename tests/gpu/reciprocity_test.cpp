// Light that goes the other way is reflected alike (Helmholtz): a factor of one side alone, such as masking
// without shadowing, is seen here in every sample, and in whole images hardly at all.
#include "tests/support/probe.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kPairs = 1 << 14;
// Rounding of a narrow lobe's half vector.
constexpr float kTolerance = 2e-3F;

// f_r in both directions of time, for materials of random colour, metallic and roughness.
TEST(Reciprocity, OfGlossySurfaces) {
  device();
  const auto results =
      probe<glm::vec4>("vec4", {"material/own_lobes.glsl", "sampling/random.glsl"},
                       "vec3 upward(vec2 u) {\n"
                       "  float r = sqrt(1.0 - u.x * u.x);\n"
                       "  return vec3(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), u.x);\n"
                       "}\n",
                       "vec4 u = random_units(RandomKey(index, 1u, 7u), 1u);\n"
                       "vec4 v = random_units(RandomKey(index, 2u, 7u), 1u);\n"
                       "Surface s;\n"
                       "s.normal = s.geometric_normal = vec3(0.0, 0.0, 1.0);\n"
                       "Bsdf b;\n"
                       "b.base_color = v.xyz;\n"
                       "b.metallic = v.w < 0.3 ? 0.0 : v.w > 0.7 ? 1.0 : v.w;\n"
                       "b.dielectric_f0 = vec4(0.04, 0.04, 0.04, 1.0);\n"
                       "b.alpha = 0.05 + 0.9 * fract(v.x * 17.0);\n"
                       "vec3 a = upward(vec2(0.05 + 0.95 * u.x, u.y));\n"
                       "vec3 c = upward(vec2(0.05 + 0.95 * u.z, u.w));\n"
                       "result = vec4(average(bsdf_cosine(s, b, a, c)) / c.z, average(bsdf_cosine(s, b, c, "
                       "a)) / a.z, 0.0, 0.0);",
                       kPairs, {{"HAS_SPECULAR", "1"}});
  for (const glm::vec4& r : results) {
    EXPECT_GT(r.x, 0);
    EXPECT_NEAR(r.x / r.y, 1, kTolerance);
  }
}

}  // namespace
}  // namespace qtrace::test
