// How the time of a frame grows with the size of the problem.
#pragma once

#include "engine/gpu/context.h"

#include <filesystem>

namespace qtrace::bench {

struct GrowthBenchOptions {
  int rounds = 0;
  int size = 0;      // pixels along a side of the image, where that is not what grows
  double share = 1;  // of the values of each axis, from the smallest
  std::filesystem::path out;
};

// One axis after another, triangles, sites, bins, bounces and pixels, from the settings of Goswami's
// table. Prints a table and writes growth.csv and growth_rounds.csv.
void bench_growth(const gpu::Context& context, const GrowthBenchOptions& options);

}  // namespace qtrace::bench
