// What the host writes is what shaders and the host read, whatever came before it.
#include "tests/support/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace qtrace::test {
namespace {

using Words = std::vector<std::uint32_t>;

Words counted(std::size_t count, std::uint32_t first) {
  Words words(count);
  std::iota(words.begin(), words.end(), first);
  return words;
}

// As a shader reads it.
Words seen_by_shader(const gpu::Buffer& buffer) {
  buffer.bind_storage(gpu::BINDING_SAMPLES);
  return probe<std::uint32_t>(
      "uint", {"shared/structs.glsl"},
      "layout(std430, binding = BINDING_SAMPLES) readonly buffer InputBuffer { uint words[]; };",
      "result = words[index];", static_cast<std::uint32_t>(buffer.bytes() / sizeof(std::uint32_t)));
}

void expect_words(const gpu::Buffer& buffer, const Words& words) {
  EXPECT_TRUE(seen_by_shader(buffer) == words) << "in a shader";
  EXPECT_TRUE(buffer.read_all<std::uint32_t>() == words) << "on the host";
}

class BufferOf : public testing::TestWithParam<std::size_t> {};

TEST_P(BufferOf, WordsHoldsThoseThatItWasMadeOf) {
  device();
  const Words words = counted(GetParam(), 7);
  expect_words(gpu::Buffer("words", words), words);
}

TEST_P(BufferOf, WordsBeginsWithZeros) {
  device();
  expect_words(gpu::Buffer("words", 4 * GetParam()), Words(GetParam(), 0));
}

TEST_P(BufferOf, WordsHoldsWhatIsWrittenRightAfterItWasCleared) {
  device();
  const Words words = counted(GetParam(), 3);
  gpu::Buffer buffer("words", 4 * GetParam());
  buffer.write(0, words.data(), 4 * words.size());
  expect_words(buffer, words);
  buffer.clear();
  buffer.write(0, words.data(), 4 * words.size());
  expect_words(buffer, words);
}

TEST_P(BufferOf, WordsIsWrittenInPart) {
  device();
  Words words = counted(GetParam(), 5);
  gpu::Buffer buffer("words", words);
  const Words part(GetParam() / 2, 1);
  buffer.write(4, part.data(), 4 * part.size());
  std::copy(part.begin(), part.end(), words.begin() + 1);
  expect_words(buffer, words);
  buffer.clear(0, 4);
  words[0] = 0;
  expect_words(buffer, words);
}

// From what commands carry themselves to what drivers stage.
INSTANTIATE_TEST_SUITE_P(Sizes, BufferOf, testing::Values(1, 2, 16, 1000, 100'000, 4'000'000),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace qtrace::test
