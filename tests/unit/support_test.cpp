// The tests' own tools: one that always says yes would hide what it is for.
#include "tests/support/members.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace qtrace::test {
namespace {

TEST(ChiSquared, IsTheChanceOfAWorseFit) {
  // Two degrees of freedom: exp(-x / 2) of x = (100 + 0 + 100) / 100.
  EXPECT_NEAR(chi_squared_p({110, 100, 90}, {100, 100, 100}), 1 / std::numbers::e, 1e-12);
  EXPECT_EQ(chi_squared_p({100, 100}, {100, 100}), 1);
  EXPECT_LT(chi_squared_p({0, 0}, {100, 100}), 1e-40);
}

TEST(ChiSquared, PoolsUntilTenAreExpected) {
  const double pooled = chi_squared_p({14, 20, 6}, {10, 20, 10});
  EXPECT_EQ(chi_squared_p({7, 7, 20, 6}, {5, 5, 20, 10}), pooled);
  // Those left at the end join the last pool.
  EXPECT_EQ(chi_squared_p({14, 20, 4, 2}, {10, 20, 9.5, 0.5}), chi_squared_p({14, 20, 6}, {10, 20, 10}));
  EXPECT_EQ(chi_squared_p({10, 20, 1}, {10, 20, 0}), 0);  // where nothing is expected
}

TEST(ChiSquared, FewerThanTwoPoolsShowNothing) {
  EXPECT_THROW(chi_squared_p({}, {}), std::invalid_argument);
  EXPECT_THROW(chi_squared_p({0, 9}, {5, 4}), std::invalid_argument);
  EXPECT_THROW(chi_squared_p({500, 2}, {500, 2}), std::invalid_argument);
  EXPECT_THROW(chi_squared_p({10, 10, 10}, {10, 20}), std::invalid_argument);
}

struct Nested {
  double x = 0;
  bool flag = false;
};

struct Example {
  int number = 0;
  std::string text;
  std::optional<double> maybe;
  std::vector<Nested> list;
};

TEST(Members, AllAreCountedFilledAndCompared) {
  static_assert(member_count<Nested>() == 2);
  static_assert(member_count<Example>() == 4);
  Example a;
  int last = 0;
  fill(a, last);
  EXPECT_EQ(last, 5);  // number, text, maybe and the x of two elements
  EXPECT_TRUE(a.number == 1 && a.text == "text 2" && a.maybe > 3 && a.list.at(1).flag);
  const auto differences = [&](const Example& b) {
    std::vector<std::string> found;
    find_differences(a, b, "", found);
    return found;
  };
  EXPECT_EQ(differences(a), std::vector<std::string>{});
  EXPECT_EQ(differences({}), (std::vector<std::string>{".0", ".1", ".2?", ".3.size"}));
  Example b = a;
  b.list[1].flag = false;
  EXPECT_EQ(differences(b), (std::vector<std::string>{".3[1].1"}));
}

}  // namespace
}  // namespace qtrace::test
