// Feeds bytes to the reader of Radiance's pictures.
#include "engine/core/check.h"
#include "experiments/images/radiance_hdr.h"
#include "tests/fuzz/expect.h"

#include <cstdint>

namespace qtrace::fuzz {
namespace {

// What the sanitizers can read in a second; the reader's user limits sizes as well.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 20U;

void read(std::string_view bytes) {
  const experiments::HdrHeader header = experiments::read_hdr_header(bytes);
  expect(header.size <= bytes.size(), "the pixels must begin in the file", std::to_string(header.size));
  const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
  if (pixels > kMostPixels) return;
  const std::vector<glm::vec3> read = experiments::read_hdr_pixels(bytes, header);
  expect(read.size() == pixels, "there must be as many pixels as the header says",
         std::to_string(read.size()));
}

}  // namespace
}  // namespace qtrace::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    qtrace::fuzz::read({reinterpret_cast<const char*>(data), size});
  } catch (const qtrace::Error& error) {
    qtrace::fuzz::expect_message(error.what());
  }
  return 0;
}
