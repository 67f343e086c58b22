// Random numbers of one pixel.
#pragma once

#include <cstdint>
#include <random>

namespace qtrace::independent {

struct Random {
  std::mt19937_64 bits;
  double operator()() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
};

}  // namespace qtrace::independent
