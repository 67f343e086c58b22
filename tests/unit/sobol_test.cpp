// Sobol's sequence, against published points and the strata that it must fill.
#include "engine/tracer/sobol.h"

#include "engine/tracer/stratified_points.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

namespace qtrace {
namespace {

double coordinate(std::uint32_t index, int dimension) { return sobol(index, dimension) / 4294967296.0; }

// The points of scipy.stats.qmc.Sobol (Joe & Kuo 2008), which lists them in Gray-code order: its point n is
// that of index n ^ (n >> 1).
TEST(Sobol, HasThePublishedPoints) {
  constexpr std::array<int, kSobolDimensions> kPoint100{152, 792,  712, 984, 536, 72,  40,  600,
                                                        120, 1016, 328, 104, 824, 920, 952, 648};
  constexpr std::array<int, kSobolDimensions> kPoint777{579, 193, 913, 183, 277,  131, 821, 227,
                                                        707, 873, 425, 439, 1019, 303, 201, 525};
  for (int d = 0; d < kSobolDimensions; ++d) {
    EXPECT_EQ(coordinate(1, d), 0.5);
    EXPECT_EQ(coordinate(100, d) * 1024, kPoint100[static_cast<std::size_t>(d)]) << d;
    EXPECT_EQ(coordinate(777, d) * 1024, kPoint777[static_cast<std::size_t>(d)]) << d;
  }
}

// Of the first 2^k points each dimension has one in every interval of length 2^-k.
TEST(Sobol, FillsEveryDimension) {
  for (int d = 0; d < kSobolDimensions; ++d) {
    std::set<std::uint32_t> strata;
    for (std::uint32_t i = 0; i < 1024; ++i) strata.insert(sobol(i, d) >> 22);
    EXPECT_EQ(strata.size(), 1024U) << d;
  }
}

// The first two dimensions are a (0, 2)-sequence: one point in every box of 2^-a by 2^-b, a + b = k.
TEST(Sobol, FillsEveryBoxOfTheFirstTwoDimensions) {
  for (const std::uint32_t first : {0U, 256U, 768U}) {
    for (int a = 0; a <= 8; ++a) {
      std::set<std::uint32_t> boxes;
      for (std::uint32_t i = first; i < first + 256; ++i) {
        const auto x = static_cast<std::uint32_t>(std::uint64_t{sobol(i, 0)} >> (32 - a));
        const auto y = static_cast<std::uint32_t>(std::uint64_t{sobol(i, 1)} >> (24 + a));
        boxes.insert(x << (8 - a) | y);
      }
      EXPECT_EQ(boxes.size(), 256U) << first << ", " << a;
    }
  }
}

TEST(Sobol, ReversesBits) {
  EXPECT_EQ(reversed_bits(1), 0x80000000U);
  EXPECT_EQ(reversed_bits(0x12345678U), 0x1e6a2c48U);
}

// Whole ranges of 2^k indices become whole ranges, in another order with every seed.
TEST(Sobol, ShufflesRangesIntoRanges) {
  for (const std::uint32_t size : {2U, 16U, 256U}) {
    for (const std::uint32_t first : {0U, 5 * size}) {
      std::vector<std::vector<std::uint32_t>> orders;
      for (const std::uint32_t seed : {1U, 0x9e3779b9U}) {
        std::vector<std::uint32_t> to;
        for (std::uint32_t i = first; i < first + size; ++i) to.push_back(shuffled(i, seed));
        const std::set<std::uint32_t> ranges = [&] {
          std::set<std::uint32_t> all;
          for (const std::uint32_t i : to) all.insert(i / size);
          return all;
        }();
        EXPECT_EQ(ranges.size(), 1U) << size;
        EXPECT_EQ(std::set<std::uint32_t>(to.begin(), to.end()).size(), size);
        for (std::uint32_t& i : to) i %= size;
        orders.push_back(to);
      }
      if (size > 2) {
        EXPECT_NE(orders[0], orders[1]) << size;
      }
    }
  }
}

TEST(StratifiedPoints, AreTheSameForTheSameKeyAndOthersForAnother) {
  const auto points = [](std::uint32_t seed, std::uint32_t sequence) {
    std::vector<gpu::uvec4> all;
    for (std::uint32_t i = 0; i < 8; ++i) {
      for (const gpu::uvec4& p : stratified_points(seed, sequence, i, 2)) all.push_back(p);
    }
    return all;
  };
  EXPECT_EQ(points(1, 2), points(1, 2));
  EXPECT_NE(points(1, 2), points(2, 2));
  EXPECT_NE(points(1, 2), points(1, 3));
}

// A word that no group sets would be zero before it is scrambled: the same in every frame.
TEST(StratifiedPoints, SetEveryWordThatPathsUse) {
  std::vector<gpu::uvec4> used = stratified_points(7, 0, 0, 2);
  for (gpu::uvec4& word : used) word = gpu::uvec4(0);
  for (std::uint32_t i = 0; i < 16; ++i) {
    const auto points = stratified_points(7, 0, i, 2);
    for (std::size_t b = 0; b < points.size(); ++b) used[b] |= points[b];
  }
  EXPECT_EQ(used.size(), 1 + 2 * std::size_t{gpu::BLOCKS_PER_EVENT});
  EXPECT_TRUE(used[gpu::BLOCK_CAMERA].x != 0 && used[gpu::BLOCK_CAMERA].y != 0);
  for (std::size_t b = 1; b < used.size(); ++b) {
    const bool is_two_ray = b % gpu::BLOCKS_PER_EVENT == gpu::BLOCK_TWO_RAY % gpu::BLOCKS_PER_EVENT;
    for (int c = is_two_ray ? 1 : 0; c < 4; ++c) EXPECT_NE(used[b][c], 0U) << b << ", " << c;
  }
}

}  // namespace
}  // namespace qtrace
