// Feeds bytes to the decoders of PNG and JPEG.
#include "engine/core/check.h"
#include "engine/picture/picture.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/json_mutator.h"

#include <cstdint>

namespace qtrace::fuzz {
namespace {

// What the sanitizers can decode in a second.
constexpr std::size_t kMostTexels = std::size_t{1} << 18U;

void decode(picture::Bytes bytes) {
  const picture::Size size = picture::read_size(bytes, "fuzz");
  if (std::size_t{size.width} * size.height > kMostTexels) return;
  const TextureImage image = picture::decode(bytes, "fuzz");
  expect(image.width == size.width && image.height == size.height, "the size is that of the header",
         "another");
  expect(image.texels.size() == std::size_t{size.width} * size.height, "an image has all of its texels",
         std::to_string(image.texels.size()));
}

// So that a change of bytes reaches the decoder behind the check sum of its chunk. PNG, annex D.
std::uint32_t crc(std::string_view bytes) {
  std::uint32_t c = 0xffffffffU;
  for (const char byte : bytes) {
    c ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) c = (c & 1U) != 0 ? 0xedb88320U ^ c >> 1U : c >> 1U;
  }
  return ~c;
}

std::size_t word_at(const std::string& bytes, std::size_t offset) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[offset + i]);
  return value;
}

void mend_check_sums(std::string& bytes) {
  for (std::size_t chunk = 8; chunk + 12 <= bytes.size();) {
    const std::size_t size = word_at(bytes, chunk);
    if (size > bytes.size() - chunk - 12) return;
    const std::uint32_t sum = crc(std::string_view(bytes).substr(chunk + 4, size + 4));
    for (std::size_t i = 0; i < 4; ++i) bytes[chunk + 8 + size + i] = static_cast<char>(sum >> (24 - 8 * i));
    chunk += 12 + size;
  }
}

}  // namespace
}  // namespace qtrace::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace qtrace;
  try {
    fuzz::decode({data, size});
  } catch (const Error& error) {
    fuzz::expect_message(error.what());
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
  using namespace qtrace::fuzz;
  std::string changed = mutate_bytes(as_text(data, size), max_size);
  if (seed % 8 != 0 && changed.starts_with("\x89PNG")) mend_check_sums(changed);
  return store(changed, data, max_size);
}
