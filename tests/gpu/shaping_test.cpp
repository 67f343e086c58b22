// What becomes of learned values before directions are drawn: shrinkage, the product with the cosine, the
// mixture with the BSDF. Against values worked out by hand.
#include "tests/support/learning_stage.h"

#include <gtest/gtest.h>

#include <numeric>

namespace qtrace::test {
namespace {

class Shaping : public LearningStage {
 protected:
  void build_bins(int theta, int phi) {
    settings_.rl.bins_theta = theta;
    settings_.rl.bins_phi = phi;
    build();
    bins_ = static_cast<std::size_t>(theta * phi);
  }

  // Of the first cell.
  std::vector<double> probabilities() const {
    std::vector<double> result;
    for (const glm::vec4& v :
         probe<glm::vec4>("vec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                          "result = vec4(action_probability(first_bin(0u), uint(BINS), index));",
                          static_cast<std::uint32_t>(bins_), defines_)) {
      result.push_back(v.x);
    }
    return result;
  }

  double share() const {
    return probe<glm::vec4>("vec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                            "result = vec4(fetch_one(bsdf_shares, 0));", 1, defines_)[0]
        .x;
  }

  // So many targets of one size for an action of the first cell, in units of the brightest light squared.
  void teach_share(const std::string& side, float square, std::uint32_t count) {
    table_->bind();
    probe<glm::uvec4>("uvec4", {"shared/variants.glsl", "learning/qtable.glsl"}, "",
                      "result = uvec4(gather_light_target(first_share(0u) + " + side + ", " +
                          std::to_string(square) + ") ? 1u : 0u);",
                      count, defines_);
    counters_.bind_storage(gpu::BINDING_COUNTERS);
  }

  std::size_t bins_ = 4;
};

// Rows of 4 bins have mean cosines 1/8, 3/8, 5/8, 7/8 (cylindrical).
TEST_F(Shaping, ProductWithTheCosine) {
  settings_.rl.bin_weight = BinWeight::value_cosine;
  build_bins(4, 2);
  table_->set_values(std::vector<float>(table_->values().size(), 2.0F));
  const std::vector<double> drawn = probabilities();
  const double floor = settings_.rl.bin_floor;
  for (std::size_t bin = 0; bin < bins_; ++bin) {
    const double cosine = (static_cast<double>(bin / 2) + 0.5) / 4;
    EXPECT_NEAR(drawn[bin], (1 - floor) * cosine / 4 + floor / 8, 1e-6) << bin;
  }
}

// 4 x 4 bins are blocks of one bin each. With w = 2: bin 0 has 6 targets of 8, bin 5 has 2 of 1.
//   weights n / (n + w): 3/4 and 1/2; the cell's mean (3/4 * 8 + 1/2 * 1) / (5/4) = 5.2
//   blocks: 3/4 * 8 + 1/4 * 5.2 = 7.3 and 1/2 * 1 + 1/2 * 5.2 = 3.1, else 5.2
//   bins: 3/4 * 8 + 1/4 * 7.3 = 7.825 and 1/2 * 1 + 1/2 * 3.1 = 2.05, else 5.2
TEST_F(Shaping, ShrinksTowardsBlockAndCell) {
  settings_.rl.shrinkage = 2;
  build_bins(4, 4);
  teach("index < 6u ? 0u : 5u", "index < 6u ? 8.0 : 1.0", 8);
  const std::vector<double> drawn = probabilities();
  const double total = 7.825 + 2.05 + 14 * 5.2;
  const double floor = settings_.rl.bin_floor;
  for (std::size_t bin = 0; bin < bins_; ++bin) {
    const double value = bin == 0 ? 7.825 : bin == 5 ? 2.05 : 5.2;
    EXPECT_NEAR(drawn[bin], (1 - floor) * value / total + floor / 16, 1e-6) << bin;
  }
  EXPECT_FLOAT_EQ(table_->values()[0], 8);  // what was learned stays as it is
  EXPECT_FLOAT_EQ(table_->values()[1], 0);
}

// 8 x 8 bins have blocks of 2 x 2: bin (0, 1) is pulled by its neighbour (0, 0), and (0, 2) by the cell
// alone.
TEST_F(Shaping, ABlockIsAQuarterOfTheSquareWide) {
  settings_.rl.shrinkage = 2;
  build_bins(8, 8);
  teach("0u", "8.0", 6);
  teach("63u", "0.0", 6);
  const std::vector<double> drawn = probabilities();
  EXPECT_NEAR(drawn[0] / drawn[1], (0.75 * 8 + 0.25 * 7) / 7, 0.02);
  EXPECT_NEAR(drawn[1], drawn[9], 1e-6);
  EXPECT_NEAR(drawn[2], drawn[40], 1e-6);
  EXPECT_GT(drawn[1], 1.5 * drawn[2]);
}

// 300 squares of 0.04 by the BSDF and 100 of 0.36 by the table: 12 against 36, so 1/4 by the BSDF, which is
// below the least share of 0.3. The other way round 3/4, above its complement. Ten of one size each stay near
// bsdf_fraction.
TEST_F(Shaping, MixtureFollowsTheSquaresWithinItsBounds) {
  settings_.rl.mixture = Mixture::learned;
  settings_.rl.bsdf_fraction = 0.5;
  build();
  EXPECT_FLOAT_EQ(static_cast<float>(share()), 0.5F);
  teach_share("SHARE_BSDF", 0.04F, 300);
  teach_share("SHARE_TABLE", 0.36F, 100);
  table_->learn();
  EXPECT_NEAR(share(), 0.3, 1e-6);
  build();
  teach_share("SHARE_BSDF", 0.06F, 200);
  teach_share("SHARE_TABLE", 0.08F, 200);
  table_->learn();
  // 12 of 28, beside 32 visits' worth of 1/2.
  EXPECT_NEAR(share(), (12.0 / 28 * 400 + 0.5 * 32) / 432, 1e-4);
}

}  // namespace
}  // namespace qtrace::test
