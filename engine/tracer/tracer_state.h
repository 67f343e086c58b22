// All that a tracer has gathered, as bytes: what a later frame builds on, or a later image shows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace qtrace {

struct SavedBuffer {
  std::string name;  // the device buffer's
  std::vector<std::byte> bytes;
};

struct TracerState {
  std::uint32_t frames = 0;
  std::vector<SavedBuffer> buffers;
};

}  // namespace qtrace
