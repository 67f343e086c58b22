// What the decoders share.
#pragma once

#include <cstdint>
#include <span>

namespace qtrace::picture {

using Bytes = std::span<const unsigned char>;

struct Size {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

}  // namespace qtrace::picture
