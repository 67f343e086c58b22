// Chi-squared: every direction sampler draws in proportion to the density that it states, on the device.
#include "tests/gpu/sampler_stage.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kSamples = SamplerStage::kSamples;

Material material(float metallic = 0, float specular = 0, float roughness = 1) {
  Material m;
  m.base_color = glm::vec3(0.8F);
  m.metallic = metallic;
  m.specular = specular;
  m.roughness = roughness;
  return m;
}

std::vector<SamplerCase> cases() {
  const Material plastic = material(0, 1, 0.5F);
  return {{"Lambert", Sampler::bsdf, 0, 0, material()},
          {"uniform", Sampler::uniform, 0, 0, material()},
          {"rough metal", Sampler::bsdf, 0, 0, material(1, 1, 0.8F)},
          {"glossy metal", Sampler::bsdf, 0, 0, material(1, 1, 0.4F)},
          {"plastic", Sampler::bsdf, 0, 0, plastic},
          {"table of zeros", Sampler::rl, 0, 0, material()},
          {"random table", Sampler::rl, 0, 1, material()},
          {"one huge bin", Sampler::rl, 0, 2, material()},
          {"random table with Lambert", Sampler::rl, 0.3, 1, material()},
          {"random table with plastic", Sampler::rl, 0.5, 1, plastic},
          {"tilted Lambert", Sampler::bsdf, 0, 0, material(), true},
          {"tilted plastic", Sampler::bsdf, 0, 0, plastic, true},
          {"tilted uniform", Sampler::uniform, 0, 0, material(), true},
          {"tilted random table", Sampler::rl, 0.3, 1, material(), true},
          {"random table on the back face", Sampler::rl, 0.3, 1, material(), true, true}};
}

TEST(Samplers, DrawWhatTheyState) {
  device();
  for (const SamplerCase& c : cases()) {
    SCOPED_TRACE(c.name);
    const SamplerStage stage(c);
    const double p = chi_squared_p(stage.draws().counts, stage.stated().counts);
    EXPECT_GT(p, kFalseAlarm / static_cast<double>(cases().size()));
  }
}

// Random numbers: the four words of a block, and neighbouring pixels, frames and blocks, fill the square of
// any two of them evenly.
TEST(Samplers, RandomNumbersAreUniformAndUncorrelated) {
  device();
  const std::vector<std::string> neighbours{
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).xy)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).zw)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).x, random_bits(RandomKey(index + 1u, 1u, 9u), 1u).x)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).x, random_bits(RandomKey(index, 2u, 9u), 1u).x)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).y, random_bits(RandomKey(index, 1u, 9u), 2u).y)",
      "uvec2(random_bits(RandomKey(index, 1u, 9u), 1u).w, random_bits(RandomKey(index, 1u, 10u), 1u).w)"};
  for (const std::string& pair : neighbours) {
    SCOPED_TRACE(pair);
    const auto words = probe<glm::uvec4>("uvec4", {"shared/structs.glsl", "sampling/random.glsl"}, "",
                                         "result = uvec4(" + pair + ", 0u, 0u);", kSamples);
    constexpr std::size_t kSide = 64;
    std::vector<double> counts(kSide * kSide);
    for (const glm::uvec4& w : words) ++counts[(w.x >> 26) * kSide + (w.y >> 26)];
    const std::vector<double> expected(counts.size(),
                                       static_cast<double>(kSamples) / static_cast<double>(counts.size()));
    EXPECT_GT(chi_squared_p(counts, expected), kFalseAlarm / static_cast<double>(neighbours.size()));
  }
}

}  // namespace
}  // namespace qtrace::test
