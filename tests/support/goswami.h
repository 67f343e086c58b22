// Goswami's settings of the table, on which tests of single mechanisms build: nothing shrunk, mixed or
// learned besides.
#pragma once

#include "engine/core/rl_settings.h"

namespace qtrace::test {

inline RlSettings goswami_table() {
  RlSettings rl;
  rl.learns = Learns::all;
  rl.site_placement = SitePlacement::uv;
  rl.sites_per_object = 100;
  rl.bins_theta = rl.bins_phi = 10;
  rl.bin_weight = BinWeight::value;
  rl.shrinkage = 0;
  rl.mixture = Mixture::fixed;
  rl.bin_floor = 0.1;
  rl.roulette = Roulette::throughput;
  rl.teach_frames = 0;
  rl.update_growth = 0;
  rl.trial_frames = 0;
  return rl;
}

}  // namespace qtrace::test
