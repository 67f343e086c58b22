// Owen-scrambled points as paths get them.
#include "engine/gpu/program.h"
#include "engine/tracer/stratified_points.h"
#include "tests/support/device.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace qtrace::test {
namespace {

constexpr std::uint32_t kPixels = 4096;
constexpr std::uint32_t kSeed = 9;
constexpr std::size_t kBlocks = 1 + gpu::BLOCKS_PER_EVENT;

using Words = std::array<glm::uvec4, kBlocks>;

struct WordName {
  std::size_t block;
  int component;

  std::uint32_t of(const Words& words) const { return words[block][component]; }
  double unit(const Words& words) const { return of(words) / 4294967296.0; }
};

std::string name_of(WordName word) {
  return "block " + std::to_string(word.block) + ", word " + std::to_string(word.component);
}

// What a path draws from at its first event, by the group of words that are one point.
const std::vector<std::vector<WordName>> kGroups{
    {{gpu::BLOCK_CAMERA, 0}, {gpu::BLOCK_CAMERA, 1}},
    {{gpu::BLOCK_LIGHT, 1}, {gpu::BLOCK_LIGHT, 2}, {gpu::BLOCK_LIGHT, 0}, {gpu::BLOCK_MORE, 0}},
    {{gpu::BLOCK_DIRECTION, 1},
     {gpu::BLOCK_DIRECTION, 2},
     {gpu::BLOCK_DIRECTION, 3},
     {gpu::BLOCK_DIRECTION, 0}},
    {{gpu::BLOCK_TWO_RAY, 1}, {gpu::BLOCK_TWO_RAY, 2}, {gpu::BLOCK_TWO_RAY, 3}},
    {{gpu::BLOCK_LIGHT, 3}, {gpu::BLOCK_MORE, 1}, {gpu::BLOCK_MORE, 2}, {gpu::BLOCK_MORE, 3}}};

std::vector<WordName> all_words() {
  std::vector<WordName> all;
  for (const auto& group : kGroups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

// The words of every pixel in any frame.
class PathWords {
 public:
  std::vector<Words> of(std::uint32_t sequence, std::uint32_t index) {
    program_.set_point(sequence, stratified_points(kSeed, sequence, index, 1));
    output_.bind_storage(gpu::BINDING_OUTPUT);
    program_.dispatch(kPixels / 64);
    device().finish();
    return output_.read_all<Words>();
  }

 private:
  static gpu::ShaderSource source() {
    const std::string text =
        "#version 450 core\n"
        "#include \"sampling/path_bits.glsl\"\n"
        "layout(local_size_x = 64) in;\n"
        "layout(std430, binding = BINDING_OUTPUT) buffer WordBuffer { uvec4 words[]; };\n"
        "void main() {\n"
        "  uint index = gl_GlobalInvocationID.x;\n"
        "  RandomKey key = RandomKey(index, 1u, " +
        std::to_string(kSeed) +
        "u);\n"
        "  EventBits bits = event_bits(path_bits(key), key, 0u);\n"
        "  words[5u * index] = sobol_bits(key, BLOCK_CAMERA);\n"
        "  words[5u * index + 1u] = bits.direction;\n"
        "  words[5u * index + 2u] = bits.light;\n"
        "  words[5u * index + 3u] = bits.two_ray;\n"
        "  words[5u * index + 4u] = bits.more;\n"
        "}\n";
    return gpu::assemble("path_words", text, gpu::for_driver({{"RANDOM", "1"}, {"STRATIFIED_EVENTS", "1"}}));
  }

  gpu::Program program_{source()};
  gpu::Buffer output_{"words", kPixels * sizeof(Words)};
};

class SobolPoints : public testing::Test {
 protected:
  SobolPoints() { device(); }
};

// Over pixels, whatever the point: each scrambles in a way of its own. Neighbours, blocks and sequences do
// not resemble one another.
TEST_F(SobolPoints, AreUniformAndIndependentOverPixels) {
  PathWords words;
  const std::vector<Words> first = words.of(0, 5);
  const std::vector<Words> next = words.of(0, 6);
  const std::vector<Words> other = words.of(32, 5);
  const std::vector<WordName> names = all_words();
  constexpr std::size_t kSide = 16;
  std::size_t tests = 0;
  std::vector<std::pair<std::string, double>> found;
  const auto compare = [&](const std::string& what, const auto& x, const auto& y) {
    std::vector<double> counts(kSide * kSide);
    for (std::size_t i = 0; i < kPixels; ++i) ++counts[(x(i) >> 28) * kSide + (y(i) >> 28)];
    const std::vector<double> expected(counts.size(), kPixels / static_cast<double>(counts.size()));
    found.emplace_back(what, chi_squared_p(counts, expected));
    ++tests;
  };
  for (const WordName a : names) {
    const auto word = [&](std::size_t i) { return a.of(first[i]); };
    compare(name_of(a) + " and the pixel's beside it", word,
            [&](std::size_t i) { return a.of(first[(i + 1) % kPixels]); });
    compare(name_of(a) + " and of another sequence", word, [&](std::size_t i) { return a.of(other[i]); });
    for (const WordName b : names) {
      if (&a == &b || (a.block == b.block && a.component == b.component)) continue;
      compare(name_of(a) + " and " + name_of(b), word, [&](std::size_t i) { return b.of(first[i]); });
      compare(name_of(a) + " and in the next frame " + name_of(b), word,
              [&](std::size_t i) { return b.of(next[i]); });
    }
  }
  for (const auto& [what, p] : found) EXPECT_GT(p, kFalseAlarm / static_cast<double>(tests)) << what;
}

// In each pixel, the 16 points of a stretch have one in every box of the first two words of each group, and
// one in every sixteenth of every word.
TEST_F(SobolPoints, AreNetsInEveryPixel) {
  PathWords words;
  std::vector<std::vector<Words>> frames;
  for (std::uint32_t i = 16; i < 32; ++i) frames.push_back(words.of(3, i));
  for (const auto& group : kGroups) {
    for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
      for (const WordName word : group) {
        std::set<std::uint32_t> strata;
        for (const auto& frame : frames) strata.insert(word.of(frame[pixel]) >> 28);
        ASSERT_EQ(strata.size(), 16U) << name_of(word);
      }
      std::set<std::uint32_t> boxes;
      for (const auto& frame : frames) {
        boxes.insert((group[0].of(frame[pixel]) >> 30) << 2 | group[1].of(frame[pixel]) >> 30);
      }
      ASSERT_EQ(boxes.size(), 16U) << name_of(group[0]);
    }
  }
}

// The mean over a pixel's frames of a product of two groups' words goes to the product of their means. Were
// two groups scrambled alone, with the same index, the leading digit of one would decide that of the other, a
// different one in every pixel: right in the mean over pixels, and never within one.
TEST_F(SobolPoints, OfDifferentGroupsAreNotTiedWithinAPixel) {
  constexpr std::uint32_t kFrames = 128;
  constexpr std::uint32_t kSequences = 8;  // how one is shuffled is left to chance
  PathWords words;
  const std::vector<WordName> names = all_words();
  std::vector<std::size_t> group_of;
  for (std::size_t g = 0; g < kGroups.size(); ++g) group_of.insert(group_of.end(), kGroups[g].size(), g);
  std::vector<std::vector<double>> sums(names.size() * names.size(),
                                        std::vector<double>(kPixels * kSequences));
  for (std::uint32_t n = 0; n < kFrames * kSequences; ++n) {
    const std::uint32_t sequence = n / kFrames;
    const std::vector<Words> frame = words.of(sequence, n % kFrames);
    for (std::size_t a = 0; a < names.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (group_of[a] == group_of[b]) continue;
        std::vector<double>& sum = sums[a * names.size() + b];
        for (std::size_t p = 0; p < kPixels; ++p) {
          const bool high_a = names[a].of(frame[p]) >> 31 != 0;
          const bool high_b = names[b].of(frame[p]) >> 31 != 0;
          sum[sequence * kPixels + p] += high_a == high_b ? 1 : -1;
        }
      }
    }
  }
  for (std::size_t a = 0; a < names.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (group_of[a] == group_of[b]) continue;
      double squares = 0;
      for (const double sum : sums[a * names.size() + b]) squares += sum * sum;
      // 0.09 for independent numbers; 1 where the digits are tied.
      const double rms = std::sqrt(squares / (kPixels * kSequences)) / kFrames;
      EXPECT_LT(rms, 0.25) << name_of(names[a]) << " and " << name_of(names[b]);
    }
  }
}

}  // namespace
}  // namespace qtrace::test
