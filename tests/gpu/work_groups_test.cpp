// How work is dealt to the groups of a dispatch.
#include "tests/support/probe.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace qtrace::test {
namespace {

// By group, which part it does.
std::vector<std::uint32_t> dealt(std::uint32_t groups, int threads, int piece_bits) {
  device();
  const auto seen = probe<std::uint32_t>(
      "uint", {"shared/structs.glsl", "shared/work_groups.glsl"}, "", "result = dealt_group();", 64 * groups,
      {{"WORK_THREADS", std::to_string(threads)}, {"WORK_PIECE_BITS", std::to_string(piece_bits)}});
  std::vector<std::uint32_t> parts(groups);
  for (std::size_t i = 0; i < groups; ++i) parts[i] = seen[64 * i];
  return parts;
}

TEST(WorkGroups, DoEveryPartOnce) {
  for (const int threads : {1, 2, 3, 16}) {
    for (const int bits : {0, 4}) {
      for (const std::uint32_t groups : {1U, 7U, 31U, 32U, 33U, 100U, 1000U}) {
        std::vector<std::uint32_t> all(groups);
        std::iota(all.begin(), all.end(), 0U);
        auto parts = dealt(groups, threads, bits);
        std::ranges::sort(parts);
        EXPECT_EQ(parts, all) << fmt::format("{} threads, pieces of 2^{}, {} groups", threads, bits, groups);
      }
    }
  }
}

TEST(WorkGroups, OfTwoThreadsTakeTurns) {
  EXPECT_EQ(dealt(7, 2, 4), (std::vector<std::uint32_t>{0, 2, 4, 1, 3, 5, 6}));  // too few for longer pieces
  const std::vector<std::uint32_t> parts = dealt(67, 2, 4);                      // 8 pieces of 4 each
  EXPECT_EQ(std::vector(parts.begin(), parts.begin() + 6), (std::vector<std::uint32_t>{0, 1, 2, 3, 8, 9}));
  EXPECT_EQ(std::vector(parts.begin() + 32, parts.begin() + 37),
            (std::vector<std::uint32_t>{4, 5, 6, 7, 12}));
  EXPECT_EQ(std::vector(parts.end() - 3, parts.end()), (std::vector<std::uint32_t>{64, 65, 66}));
  EXPECT_EQ(dealt(1000, 2, 4)[16], 32U);
}

TEST(WorkGroups, OfOneThreadKeepTheirOrder) {
  EXPECT_EQ(dealt(5, 1, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace qtrace::test
