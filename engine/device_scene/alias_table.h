// Walker's alias method: drawing from a discrete distribution with one look-up (Walker 1977, with Vose's 1991
// construction).
#pragma once

#include <cstdint>
#include <vector>

namespace qtrace::gpu {

// A slot is chosen uniformly; then itself if a random word is at most `threshold`, else `alias`.
struct AliasSlot {
  std::uint32_t alias = 0;
  std::uint32_t threshold = 0xffffffff;
};

// Weights are positive; they need not add up to 1.
std::vector<AliasSlot> build_aliases(const std::vector<double>& weights);

}  // namespace qtrace::gpu
