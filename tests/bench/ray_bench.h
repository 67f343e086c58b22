// Mrays/s of qtrace's ray queries beside Embree's.
#pragma once

#include "engine/gpu/context.h"
#include "engine/gpu/shader_source.h"

#include <filesystem>
#include <string>
#include <vector>

namespace qtrace::bench {

// The ray query compiled in one more way.
struct Variant {
  std::string name;
  gpu::Defines defines;
};

struct RayBenchOptions {
  std::vector<std::string> scenes;  // glTF files, or room:TRIANGLES
  std::vector<Variant> variants = {};
  int rounds = 0;
  int size = 0;          // pixels along a side of the image that the rays are those of
  unsigned threads = 0;  // of Embree
  std::filesystem::path out = {};
};

// Prints a table and writes rays.csv and ray_rounds.csv.
void bench_rays(const gpu::Context& context, const RayBenchOptions& options);

}  // namespace qtrace::bench
