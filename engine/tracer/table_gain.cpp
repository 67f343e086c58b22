#include "engine/tracer/table_gain.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace qtrace {
namespace {

// Keeps relative errors of dark pixels finite (the metrics' relMSE has the same); radiance squared.
constexpr double kDark = 0.01;
// A pixel's own mean of so few samples would hide what is rare and bright behind itself: means are of square
// blocks.
constexpr std::size_t kBlock = 8;  // pixels along a side
// Of the blocks, those with the largest errors: a bright sample alone shall not decide.
constexpr double kTrimmedShare = 0.02;

using Kinds = std::array<double, 2>;

struct Block {
  glm::dvec3 mean{0};  // of both kinds
  double pixels = 0;
  Kinds found{};  // radiance
  Kinds errors{};
};

std::vector<Block> blocks_of(const std::array<TriedFrames, 2>& kinds, std::size_t width) {
  const std::size_t pixels = kinds[0].mean.size();
  const std::size_t across = width / kBlock + 1;
  const auto block_of = [&](std::size_t i) { return i / width / kBlock * across + i % width / kBlock; };
  std::vector<Block> blocks(pixels == 0 ? 0 : block_of(pixels - 1) / across * across + across);
  for (std::size_t i = 0; i < pixels; ++i) {
    Block& block = blocks[block_of(i)];
    ++block.pixels;
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const glm::dvec3 mean = kinds[kind].mean[i];
      block.mean += mean / 2.0;
      block.found[kind] += mean.r + mean.g + mean.b;
    }
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    Block& block = blocks[block_of(i)];
    const glm::dvec3 mean = block.mean / block.pixels;
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const glm::dvec3 relative = kinds[kind].squared_error[i] / (mean * mean + kDark);
      block.errors[kind] += relative.r + relative.g + relative.b;
    }
  }
  // Radiance may go beyond what sums can hold, which says nothing about the table.
  std::erase_if(blocks, [](const Block& block) {
    return block.pixels == 0 || !std::isfinite(block.errors[0] + block.errors[1]) ||
           !std::isfinite(block.found[0] + block.found[1]);
  });
  return blocks;
}

}  // namespace

// The ratio of sums over blocks, and its error by linearisation (Cochran 1977, "Sampling Techniques",
// section 6.3).
Gain gain_of(const std::array<TriedFrames, 2>& kinds, int width) {
  std::vector<Block> blocks = blocks_of(kinds, static_cast<std::size_t>(width));
  std::ranges::sort(blocks, {}, [](const Block& b) { return std::max(b.errors[0], b.errors[1]); });
  const auto trimmed =
      static_cast<std::size_t>(std::ceil(kTrimmedShare * static_cast<double>(blocks.size())));
  blocks.resize(blocks.size() - std::min(trimmed, blocks.size()));
  Kinds sums{}, found{};
  for (const Block& block : blocks) {
    for (std::size_t kind = 0; kind < 2; ++kind) {
      sums[kind] += block.errors[kind];
      found[kind] += block.found[kind];
    }
  }
  // Where samples of a kind do not differ, they may all have missed the light.
  if (sums[1] == 0) return {1, std::numeric_limits<double>::infinity(), 1};
  Gain gain{sums[0] / sums[1], 0, found[1] > 0 ? found[0] / found[1] : 1};
  for (const Block& block : blocks) {
    const double residual = block.errors[0] - gain.value * block.errors[1];
    gain.error += residual * residual;
  }
  gain.error = std::sqrt(gain.error) / sums[1];
  return gain;
}

}  // namespace qtrace
