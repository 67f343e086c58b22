// Learning rates: a frame's targets in one step do what the same targets would do one after the other.
#include "tests/support/learning_stage.h"

#include <cmath>

namespace qtrace::test {
namespace {

class Rates : public LearningStage {
 protected:
  void choose(LearningRate rate) {
    settings_.rl.learning_rate = rate;
    settings_.rl.initial_table = InitialTable::constant;
    settings_.rl.initial_value = 5;
    build();
  }

  float value(std::size_t entry) const { return table_->values()[entry]; }
};

// alpha = 1 / (1 + visits) makes the value the mean of all targets, frame by frame.
TEST_F(Rates, VisitsPerBinIsTheMeanOfAllTargets) {
  choose(LearningRate::visits_per_bin);
  teach("3u", "float(index)", 101);  // mean 50
  EXPECT_NEAR(value(3), 50, 1e-4);
  EXPECT_EQ(table_->visits()[3], 101U);
  teach("3u", "200.0", 50);
  EXPECT_NEAR(value(3), (101 * 50 + 50 * 200) / 151.0, 1e-3);
  EXPECT_EQ(table_->visits()[3], 151U);
  EXPECT_EQ(value(2), 5);
  EXPECT_EQ(table_->visits()[4], 0U);
}

// One after the other, m targets T at rate a leave T + (1 - a)^m (Q - T).
TEST_F(Rates, ConstantMovesByAFixedShare) {
  settings_.rl.rate_constant = 0.1;
  choose(LearningRate::constant);
  teach("3u", "9.0", 3);
  EXPECT_NEAR(value(3), 9 + std::pow(0.9, 3) * (5 - 9), 1e-5);
  teach("3u", "1.0", 1);
  EXPECT_NEAR(value(3), 1 + 0.9 * (9 + std::pow(0.9, 3) * (5 - 9) - 1), 1e-5);
}

// Rates far below what a float adds to 1 still move a value by what they should.
TEST_F(Rates, TinyConstantKeepsItsDigits) {
  settings_.rl.rate_constant = 1e-6;
  choose(LearningRate::constant);
  for (int i = 0; i < 10; ++i) teach("3u", "1e6", 1000);
  EXPECT_NEAR((value(3) - 5) / ((1 - std::pow(1 - 1e-6, 10000)) * (1e6 - 5)), 1, 1e-4);
}

TEST_F(Rates, ConstantOneForgetsEverything) {
  settings_.rl.rate_constant = 1;
  choose(LearningRate::constant);
  teach("3u", "9.0", 3);
  EXPECT_EQ(value(3), 9);
}

// Frame by frame one target: Q += (1 + visits)^-k (T - Q), the first of them at rate 1.
TEST_F(Rates, PowerDecays) {
  settings_.rl.rate_exponent = 0.6;
  choose(LearningRate::power);
  double expected = 5;
  for (int frame = 0; frame < 12; ++frame) {
    teach("3u", std::to_string(frame * frame) + ".0", 1);
    expected += std::pow(1.0 + frame, -0.6) * (frame * frame - expected);
    EXPECT_NEAR(value(3), expected, 1e-3) << frame;
  }
}

TEST_F(Rates, PowerOneIsTheMeanOfSingleTargets) {
  settings_.rl.rate_exponent = 1;
  choose(LearningRate::power);
  for (int frame = 0; frame < 9; ++frame) teach("3u", std::to_string(frame) + ".0", 1);
  EXPECT_NEAR(value(3), 4, 1e-4);
}

// With alpha = 1 / (1 + visits(cell)) and all targets in one bin, the mean of all; another bin of the cell
// moves by the rate that the first one's visits leave, another cell's is untouched by them.
TEST_F(Rates, VisitsPerCellCountsTheWholeCell) {
  choose(LearningRate::visits_per_cell);
  teach("1u", "8.0", 100);
  EXPECT_NEAR(value(1), 8, 1e-5);
  teach("1u", "2.0", 100);
  EXPECT_NEAR(value(1), 5, 1e-4);
  teach("2u", "9.0", 1);
  EXPECT_NEAR(value(2), 5 + (9 - 5) / 201.0, 1e-5);
  teach("7u", "9.0", 1);
  EXPECT_NEAR(value(7), 9, 1e-5);
}

// Targets of two bins in one frame, against the listing's sequence with the bins mixed evenly.
TEST_F(Rates, VisitsPerCellOfMixedTargetsFollowsTheSequence) {
  choose(LearningRate::visits_per_cell);
  teach("index < 50u ? 0u : 3u", "1.0", 60);
  teach("index % 4u == 0u ? 1u : 2u", "index % 4u == 0u ? 100.0 : 10.0", 400);
  double one = 5;
  double two = 5;
  for (int i = 0; i < 400; ++i) {
    double& q = i % 4 == 0 ? one : two;
    q += ((i % 4 == 0 ? 100 : 10) - q) / (1.0 + 60 + i);
  }
  EXPECT_NEAR(value(1) / one, 1, 0.01);
  EXPECT_NEAR(value(2) / two, 1, 0.01);
}

}  // namespace
}  // namespace qtrace::test
