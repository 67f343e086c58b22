// Direction bins: both maps keep areas, are undone by their inverse, and state the mean cosine of their bins.
#include "tests/support/learning_stage.h"
#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>

namespace qtrace::test {
namespace {

const std::vector<std::string> kIncludes{"shared/variants.glsl", "geometry/scene.glsl", "sampling/random.glsl", "learning/bins.glsl"};

class Bins : public testing::TestWithParam<BinMap> {
 protected:
  Bins() {
    device();
    defines_ = {
        {"BIN_MAP", std::to_string(static_cast<int>(GetParam()))}, {"BINS_THETA", "7"}, {"BINS_PHI", "6"}};
  }

  gpu::Defines defines_;
};

INSTANTIATE_TEST_SUITE_P(Maps, Bins, testing::Values(BinMap::cylindrical, BinMap::concentric),
                         [](const auto& map) { return std::string(enum_name(map.param)); });

// Uniform points of the square become uniform directions of the hemisphere: even in cos(theta) and phi.
TEST_P(Bins, TheMapKeepsAreas) {
  constexpr std::uint32_t kPoints = 1 << 18;
  const auto directions = probe<glm::vec4>(
      "vec4", kIncludes, "",
      "result = vec4(from_square(random_units(RandomKey(index, 1u, 3u), 1u).xy), 0.0);", kPoints, defines_);
  constexpr int kSide = 24;
  std::vector<double> counts(kSide * kSide);
  for (const glm::vec4& d : directions) {
    EXPECT_NEAR(glm::length(glm::vec3(d)), 1, 1e-5);
    const double turn = std::atan2(d.y, d.x) / 6.283185307179586 + 0.5;
    const int row = std::clamp(static_cast<int>(d.z * kSide), 0, kSide - 1);
    const int column = std::clamp(static_cast<int>(turn * kSide), 0, kSide - 1);
    ++counts[static_cast<std::size_t>(row * kSide + column)];
  }
  const std::vector<double> expected(counts.size(), kPoints / static_cast<double>(counts.size()));
  EXPECT_GT(chi_squared_p(counts, expected), kFalseAlarm / 2);
}

TEST_P(Bins, ADirectionLiesInTheBinThatItWasDrawnFrom) {
  constexpr std::uint32_t kPoints = 1 << 16;
  const auto found =
      probe<glm::uvec4>("uvec4", kIncludes, "",
                        "vec2 u = random_units(RandomKey(index, 1u, 3u), 1u).xy;\n"
                        "result = uvec4(bin_of(direction_in_bin(index % uint(BINS), u)), 0u, 0u, 0u);",
                        kPoints, defines_);
  int elsewhere = 0;
  for (std::uint32_t i = 0; i < kPoints; ++i) elsewhere += found[i].x != i % 42;
  EXPECT_LE(elsewhere, 2e-4 * kPoints);  // rounding at the edges
}

TEST_P(Bins, MeanCosinesAreThoseOfAQuadrature) {
  const auto found = probe<glm::vec4>("vec4", kIncludes, "",
                                      "float sum = 0.0;\nuint i = 0u;\ndo {\n"
                                      "  vec2 u = (vec2(i % 64u, i / 64u) + 0.5) / 64.0;\n"
                                      "  sum += direction_in_bin(index, u).z;\n  ++i;\n} while (i < 4096u);\n"
                                      "result = vec4(bin_cosine(index), sum / 4096.0, 0.0, 0.0);",
                                      42, defines_);
  for (std::size_t bin = 0; bin < found.size(); ++bin) EXPECT_NEAR(found[bin].x, found[bin].y, 1e-4) << bin;
}

class InitialTables : public LearningStage {};

TEST_F(InitialTables, AreWhatTheyAreCalled) {
  settings_.rl.bins_theta = 5;
  settings_.rl.initial_value = 3;
  settings_.rl.initial_table = InitialTable::constant;
  build();
  for (const float v : table_->values()) EXPECT_EQ(v, 3);
  settings_.rl.initial_table = InitialTable::cosine;
  build();
  const std::vector<float> cosines = table_->values();
  for (std::size_t i = 0; i < cosines.size(); ++i) {
    EXPECT_NEAR(cosines[i], 3 * (static_cast<double>(i % 10 / 2) + 0.5) / 5, 1e-6);
  }
  settings_.rl.initial_table = InitialTable::zero;
  build();
  for (const float v : table_->values()) EXPECT_EQ(v, 0);
}

TEST_F(InitialTables, RandomValuesFillTheirRangeAndFollowTheSeed) {
  settings_.rl.bins_theta = settings_.rl.bins_phi = 16;
  settings_.rl.initial_value = 2;
  settings_.rl.initial_table = InitialTable::random;
  build();
  const std::vector<float> values = table_->values();
  std::vector<double> counts(32);
  for (const float v : values) ++counts[static_cast<std::size_t>(v * 16)];
  EXPECT_GT(chi_squared_p(counts, std::vector<double>(32, static_cast<double>(values.size()) / 32)),
            kFalseAlarm);
  table_->reset();
  EXPECT_EQ(table_->values(), values);
  ++settings_.seed;
  build();
  EXPECT_NE(table_->values(), values);
}

}  // namespace
}  // namespace qtrace::test
