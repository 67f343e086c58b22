#include "engine/device_scene/alias_table.h"

#include <numeric>

namespace qtrace::gpu {

std::vector<AliasSlot> build_aliases(const std::vector<double>& weights) {
  const std::size_t n = weights.size();
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<AliasSlot> slots(n);
  std::vector<double> scaled(n);
  std::vector<std::size_t> small;
  std::vector<std::size_t> large;
  for (std::size_t i = 0; i < n; ++i) {
    scaled[i] = weights[i] / total * static_cast<double>(n);
    (scaled[i] < 1 ? small : large).push_back(i);
    slots[i].alias = static_cast<std::uint32_t>(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::size_t s = small.back();
    const std::size_t l = large.back();
    small.pop_back();
    slots[s].threshold = static_cast<std::uint32_t>(scaled[s] * 4294967295.0);
    slots[s].alias = static_cast<std::uint32_t>(l);
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  return slots;
}

}  // namespace qtrace::gpu
